//! The taxi's city: cells, walls, stands.

use crate::rules::Problem;

/// Longest side of a city in cells: bounds what a hostile file can make the program compute.
const MAX_SIDE: usize = 20;
/// Largest number of stands.
const MAX_STANDS: usize = 8;

/// A direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    North,
    South,
    East,
    West,
}

impl Direction {
    pub(super) const ALL: [Self; 4] = [Self::North, Self::South, Self::East, Self::West];

    pub(super) fn right(self) -> Self {
        match self {
            Self::North => Self::East,
            Self::East => Self::South,
            Self::South => Self::West,
            Self::West => Self::North,
        }
    }

    pub(super) fn left(self) -> Self {
        self.right().right().right()
    }
}

/// A grid of cells, numbered row by row from the north-west.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct City {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Whether there is a wall to the east of each cell.
    pub(super) walled: Vec<bool>,
    /// Letter and cell of every stand, in the order of the map.
    pub(super) stands: Vec<(char, usize)>,
    /// For each cell the cells to its north, south, east and west; itself where there
    /// is a wall.
    neighbours: Vec<[usize; 4]>,
}

impl City {
    /// Reads the lines of a map. Problems have their places below the taxi's settings.
    pub(super) fn read(map: &[String]) -> Result<Self, Problem> {
        if !(1..=MAX_SIDE).contains(&map.len()) {
            let found = format!("{} rows", map.len());
            return Err(Problem::new("map", found, format!("1 to {MAX_SIDE}")));
        }
        let length = map[0].chars().count();
        let mut city = Self {
            columns: length.div_ceil(2),
            rows: map.len(),
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
        city.neighbours = (0..city.cells()).map(|cell| city.around(cell)).collect();
        city.check_ways()?;
        Ok(city)
    }

    fn read_row(&mut self, row: usize, line: &str, length: usize) -> Result<(), Problem> {
        let found = line.chars().count();
        let odd = found % 2 == 1 && found < 2 * MAX_SIDE;
        if !odd || found != length {
            let allowed = match length % 2 == 1 && row > 0 {
                true => length.to_string(),
                false => format!("an odd number up to {}", 2 * MAX_SIDE - 1),
            };
            return Err(Problem::new(
                format!("map[{row}]"),
                format!("{found} characters"),
                format!(
                    "{allowed}, a cell, then ':' or '|' and a cell any number of times, in every \
                     row alike"
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
                    let cell = row * self.columns + column / 2;
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
        // The edge of the city.
        self.walled.push(true);
        Ok(())
    }

    /// The number of cells.
    pub(super) fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// The cell that a move leads to.
    #[inline]
    pub(super) fn to(&self, cell: usize, direction: Direction) -> usize {
        self.neighbours[cell][direction as usize]
    }

    fn around(&self, cell: usize) -> [usize; 4] {
        Direction::ALL.map(|direction| match direction {
            Direction::North if cell >= self.columns => cell - self.columns,
            Direction::South if cell + self.columns < self.cells() => cell + self.columns,
            Direction::East if !self.walled[cell] => cell + 1,
            Direction::West if !cell.is_multiple_of(self.columns) && !self.walled[cell - 1] => {
                cell - 1
            }
            _ => cell,
        })
    }

    fn check_ways(&self) -> Result<(), Problem> {
        let (letter, stand) = self.stands[0];
        let mut reached = vec![false; self.cells()];
        reached[stand] = true;
        let mut open = vec![stand];
        while let Some(cell) = open.pop() {
            for next in self.neighbours[cell] {
                if !std::mem::replace(&mut reached[next], true) {
                    open.push(next);
                }
            }
        }
        match reached.iter().all(|&cell| cell) {
            true => Ok(()),
            false => Err(Problem::new(
                "map",
                format!("no way from stand {letter} to all cells"),
                "a way to all",
            )),
        }
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
        assert_eq!((city.columns, city.rows), (5, 5));
        assert_eq!(city.stands, [('R', 0), ('G', 4), ('Y', 20), ('B', 23)]);
        assert_eq!(city.to(0, Direction::North), 0);
        assert_eq!(city.to(1, Direction::East), 1, "a wall");
        assert_eq!(city.to(2, Direction::West), 2, "the same wall");
        assert_eq!(city.to(11, Direction::East), 12);
        assert_eq!(city.to(20, Direction::North), 15);
        assert_eq!(city.to(24, Direction::East), 24);
    }

    #[test]
    fn a_map_that_is_none_is_refused_with_its_place() {
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
