//! The taxi's city: cells, walls, stands.

use crate::rules::Problem;
use crate::worlds::grid::{Cells, Direction};

/// Longest side of a city in cells. It bounds the work that a hostile file can cause.
const MAX_SIDE: usize = 20;
/// Largest number of stands.
const MAX_STANDS: usize = 8;

/// A grid of cells, numbered row by row from the north-west.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct City {
    pub(super) cells: Cells,
    /// Whether there is a wall to the east of each cell.
    pub(super) walled: Vec<bool>,
    /// Letter and cell of every stand, in the order of the map.
    pub(super) stands: Vec<(char, usize)>,
    /// The cells to the north, south, east and west of each cell: the cell itself where a wall is.
    neighbours: Vec<[usize; 4]>,
}

impl City {
    /// Reads the lines of a map.
    pub(super) fn read(map: &[String]) -> Result<Self, Problem> {
        if !(1..=MAX_SIDE).contains(&map.len()) {
            let found = format!("{} rows", map.len());
            return Err(Problem::new("map", found, format!("1 to {MAX_SIDE}")));
        }
        let length = map[0].chars().count();
        let mut city = Self {
            cells: Cells {
                columns: length.div_ceil(2),
                rows: map.len(),
            },
            walled: Vec::new(),
            stands: Vec::new(),
            neighbours: Vec::new(),
        };
        for (row, line) in map.iter().enumerate() {
            city.read_row(row, line, length)?;
        }
        let found = city.stands.len();
        if !(2..=MAX_STANDS).contains(&found) {
            let found = format!("{found} stands");
            return Err(Problem::new("map", found, format!("2 to {MAX_STANDS}")));
        }
        city.neighbours = (0..city.cells.count())
            .map(|cell| city.around(cell))
            .collect();
        city.check_ways()?;
        Ok(city)
    }

    fn read_row(&mut self, row: usize, line: &str, length: usize) -> Result<(), Problem> {
        let found = line.chars().count();
        let odd = found % 2 == 1 && found < 2 * MAX_SIDE;
        if !odd || found != length {
            let allowed = if length % 2 == 1 && row > 0 {
                length.to_string()
            } else {
                format!("an odd number up to {}", 2 * MAX_SIDE - 1)
            };
            return Err(Problem::new(
                format!("map[{row}]"),
                format!("{found} characters"),
                format!(
                    "{allowed}: cells with ':' or '|' between them, the same number in every row"
                ),
            ));
        }
        for (column, found) in line.chars().enumerate() {
            let wrong = |allowed: &str| {
                let place = format!("map[{row}], character {column}");
                Problem::new(place, format!("{found:?}"), allowed)
            };
            if column % 2 == 1 {
                match found {
                    ':' | '|' => self.walled.push(found == '|'),
                    _ => return Err(wrong("':' for a way, '|' for a wall")),
                }
                continue;
            }
            let taken = self.stands.iter().any(|&(letter, _)| letter == found);
            match found {
                'A'..='Z' if !taken => {
                    let cell = row * self.cells.columns + column / 2;
                    self.stands.push((found, cell));
                }
                ' ' => {}
                _ => {
                    return Err(wrong(
                        "a space, or a capital letter that no other stand has",
                    ));
                }
            }
        }
        // East of the last cell is the edge of the city.
        self.walled.push(true);
        Ok(())
    }

    /// Returns the cell that a move leads to.
    #[inline]
    pub(super) fn to(&self, cell: usize, direction: Direction) -> usize {
        self.neighbours[cell][direction as usize]
    }

    fn around(&self, cell: usize) -> [usize; 4] {
        Direction::ALL.map(|direction| {
            let next = self.cells.neighbour(cell, direction);
            let walled = match direction {
                Direction::Right => self.walled[cell],
                Direction::Left => next.is_some_and(|next| self.walled[next]),
                Direction::Up | Direction::Down => false,
            };
            next.filter(|_| !walled).unwrap_or(cell)
        })
    }

    fn check_ways(&self) -> Result<(), Problem> {
        let (letter, stand) = self.stands[0];
        let mut reached = vec![false; self.cells.count()];
        reached[stand] = true;
        let mut open = vec![stand];
        while let Some(cell) = open.pop() {
            for next in self.neighbours[cell] {
                if !std::mem::replace(&mut reached[next], true) {
                    open.push(next);
                }
            }
        }
        if reached.iter().all(|&cell| cell) {
            return Ok(());
        }
        let found = format!("no way from stand {letter} to all cells");
        Err(Problem::new("map", found, "a way to all"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worlds::taxi::settings::MAP;

    fn read(map: &[&str]) -> Result<City, String> {
        let lines: Vec<_> = map.iter().map(|&line| line.to_owned()).collect();
        City::read(&lines).map_err(|error| error.to_string())
    }

    #[test]
    fn the_city_is_that_of_figure_2_6() {
        let city = read(&MAP).unwrap();
        assert_eq!((city.cells.columns, city.cells.rows), (5, 5));
        assert_eq!(city.stands, [('R', 0), ('G', 4), ('Y', 20), ('B', 23)]);
        assert_eq!(city.to(0, Direction::Up), 0);
        assert_eq!(city.to(1, Direction::Right), 1, "a wall");
        assert_eq!(city.to(2, Direction::Left), 2, "the same wall");
        assert_eq!(city.to(11, Direction::Right), 12);
        assert_eq!(city.to(20, Direction::Up), 15);
        assert_eq!(city.to(24, Direction::Right), 24);
    }

    #[test]
    fn a_wrong_map_is_refused_with_its_place() {
        assert!(read(&[]).unwrap_err().contains("0 rows"));
        assert!(read(&["R:G", "R"]).unwrap_err().contains("map[1]: found 1"));
        assert!(read(&["R:"]).unwrap_err().contains("odd number"));
        assert!(read(&["R:G", "R: "]).unwrap_err().contains("'R'"));
        assert!(
            read(&["R;G"])
                .unwrap_err()
                .contains("character 1: found ';'")
        );
        assert!(read(&["R: "]).unwrap_err().contains("1 stands"));
        assert!(read(&["R|G"]).unwrap_err().contains("no way from stand R"));
    }
}
