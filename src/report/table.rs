//! Tables of text, as Markdown and as CSV.

/// A table of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
    /// What the table was made from, in one line; empty if it does not say.
    pub provenance: String,
}

impl Table {
    /// Creates a table without rows.
    #[must_use]
    pub fn new(header: &[&str]) -> Self {
        Self {
            header: header.iter().map(|&name| name.to_owned()).collect(),
            ..Self::default()
        }
    }

    /// Returns the table as Markdown, followed by its provenance.
    #[must_use]
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells = cells.iter().map(|cell| cell.replace('|', "\\|"));
            format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
        };
        let rule = format!("|{}\n", " --- |".repeat(self.header.len()));
        let rows = self.rows.iter().map(|row| line(row));
        let table = line(&self.header) + &rule + &rows.collect::<String>();
        match self.provenance.as_str() {
            "" => table,
            provenance => format!("{table}\n{provenance}.\n"),
        }
    }

    /// Returns the table as CSV (RFC 4180): a `#` line with the provenance, a header, the rows.
    ///
    /// `pandas.read_csv(file, comment="#")` and R's `read.csv(file, comment.char = "#")` read it.
    #[must_use]
    pub fn csv(&self) -> String {
        let field = |cell: &String| {
            if cell.contains([',', '"', '#', '\n', '\r']) {
                format!("\"{}\"", cell.replace('"', "\"\""))
            } else {
                cell.clone()
            }
        };
        let line =
            |cells: &Vec<String>| cells.iter().map(field).collect::<Vec<_>>().join(",") + "\n";
        let provenance = match self.provenance.as_str() {
            "" => String::new(),
            provenance => format!("# {}\n", provenance.replace(['\n', '\r'], " ")),
        };
        provenance + &line(&self.header) + &self.rows.iter().map(line).collect::<String>()
    }
}

/// Formats a number for people: three significant digits, or an integer.
#[must_use]
pub fn short(value: f64) -> String {
    match value.abs() {
        _ if value.is_nan() => String::from("-"),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// Formats a p-value for people.
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
    fn fields_are_quoted_where_needed_and_provenance_comes_first() {
        let mut table = Table::new(&["tree", "n"]);
        table
            .rows
            .push(vec![String::from("a, \"b\""), String::from("1")]);
        assert_eq!(table.csv(), "tree,n\n\"a, \"\"b\"\"\",1\n");
        assert_eq!(
            table.markdown(),
            "| tree | n |\n| --- | --- |\n| a, \"b\" | 1 |\n"
        );
        table.provenance = String::from("made by\nhand");
        assert!(table.csv().starts_with("# made by hand\ntree,n\n"));
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
