//! Tables, as Markdown and as CSV.

/// A table of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    #[must_use]
    pub fn new(header: &[&str]) -> Self {
        Self {
            header: header.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// As Markdown.
    #[must_use]
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells = cells.iter().map(|cell| cell.replace('|', "\\|"));
            format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
        };
        let rule = format!("|{}\n", " --- |".repeat(self.header.len()));
        let rows = self.rows.iter().map(|row| line(row));
        line(&self.header) + &rule + &rows.collect::<String>()
    }

    /// As CSV (RFC 4180): one header, fields quoted where they need it.
    #[must_use]
    pub fn csv(&self) -> String {
        let field = |cell: &String| match cell.contains([',', '"', '\n', '\r']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.clone(),
        };
        let line =
            |cells: &Vec<String>| cells.iter().map(field).collect::<Vec<_>>().join(",") + "\n";
        line(&self.header) + &self.rows.iter().map(line).collect::<String>()
    }
}

/// A number for people: three significant digits, or whole.
#[must_use]
pub fn short(value: f64) -> String {
    match value.abs() {
        _ if value.is_nan() => String::from("-"),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// A probability for people.
#[must_use]
pub fn p_value(p: f64) -> String {
    match p {
        p if p < 0.0001 => format!("{p:.0e}"),
        p if p < 0.1 => format!("{p:.4}"),
        p => format!("{p:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_need_it_are_quoted() {
        let mut table = Table::new(&["tree", "n"]);
        table
            .rows
            .push(vec![String::from("a, \"b\""), String::from("1")]);
        assert_eq!(table.csv(), "tree,n\n\"a, \"\"b\"\"\",1\n");
        assert_eq!(
            table.markdown(),
            "| tree | n |\n| --- | --- |\n| a, \"b\" | 1 |\n"
        );
    }

    #[test]
    fn numbers_keep_three_digits() {
        assert_eq!(
            [1234.5, 99.95, 12.34, 0.126, -3.456].map(short),
            ["1234", "100.0", "12.3", "0.13", "-3.46"]
        );
        assert_eq!(
            [0.00001, 0.0312, 0.5].map(p_value),
            ["1e-5", "0.0312", "0.50"]
        );
    }
}
