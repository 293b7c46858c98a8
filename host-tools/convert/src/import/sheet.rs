//! Rows of cells between commas, tabs or semicolons below a row of names, and errors that name line and column.

use super::text::{number_in, shown};
use anyhow::{Context, Error, Result, anyhow};
use csv::{ByteRecord, Reader, ReaderBuilder, Trim};
use std::collections::HashMap;
use std::path::Path;

/// A table, read row by row.
pub struct Sheet<'a> {
    file: String,
    reader: Reader<&'a [u8]>,
    /// Names of the columns.
    pub header: Vec<String>,
}

/// A row below the header.
pub struct Row {
    /// Its line, from 1.
    pub line: u64,
    cells: ByteRecord,
}

impl Row {
    /// The content of a column; empty if the row is too short.
    pub fn cell(&self, column: usize) -> &[u8] {
        self.cells.get(column).unwrap_or_default()
    }
}

/// What stands between the cells of a table that begins with `head`: what its first line has most of.
pub fn delimiter(head: &[u8]) -> u8 {
    let line = head.trim_ascii_start().split(|&byte| byte == b'\n' || byte == b'\r').next().unwrap_or_default();
    // Between quotes stand names.
    let outside = || line.split(|&byte| byte == b'"').step_by(2).flatten();
    let count = |delimiter: u8| outside().filter(|&&byte| byte == delimiter).count();
    [b';', b'\t', b','].into_iter().max_by_key(|&delimiter| count(delimiter)).unwrap_or(b',')
}

impl<'a> Sheet<'a> {
    /// The table `bytes`, the content of `path`. Names must be UTF-8 and differ; a last column without a name is none.
    pub fn open(path: &Path, bytes: &'a [u8]) -> Result<Sheet<'a>> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut builder = ReaderBuilder::new();
        builder.delimiter(delimiter(bytes)).has_headers(false).flexible(true).trim(Trim::All);
        let reader = builder.from_reader(bytes);
        let mut sheet = Sheet { file: path.display().to_string(), reader, header: Vec::new() };
        let Some(row) = sheet.next()? else { return Err(sheet.error(1, "expected a row of column names, found nothing")) };
        let mut header = Vec::new();
        let mut seen = HashMap::new();
        for (column, cell) in row.cells.iter().enumerate() {
            let name = std::str::from_utf8(cell);
            let name = name.map_err(|_| sheet.error_in(row.line, column, format!("{} is not UTF-8", shown(Some(cell)))))?;
            if let (Some(before), false) = (seen.insert(name.to_string(), column + 1), name.is_empty()) {
                let message = format!("the name {} stands in column {before} already", shown(Some(cell)));
                return Err(sheet.error_in(row.line, column, message));
            }
            header.push(name.to_string());
        }
        if header.last().is_some_and(String::is_empty) {
            header.pop();
        }
        sheet.header = header;
        Ok(sheet)
    }

    /// The next row that has anything in it.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Result<Option<Row>> {
        let mut cells = ByteRecord::new();
        while self.reader.read_byte_record(&mut cells).with_context(|| self.file.clone())? {
            if cells.iter().any(|cell| !cell.is_empty()) {
                let line = cells.position().map_or(0, csv::Position::line);
                return Ok(Some(Row { line, cells }));
            }
        }
        Ok(None)
    }

    /// Refuses a row that has not one cell a column.
    pub fn whole(&self, row: &Row) -> Result<()> {
        let (columns, mut cells) = (self.header.len(), row.cells.len());
        if cells == columns + 1 && row.cell(columns).is_empty() {
            cells = columns;
        }
        if cells == columns {
            Ok(())
        } else {
            Err(self.error(row.line, format!("{cells} cells; expected {columns}, as the header has")))
        }
    }

    /// The number in a column.
    pub fn number(&self, row: &Row, column: usize) -> Result<f64> {
        let cell = row.cell(column);
        if cell.is_empty() {
            return Err(self.error_in(row.line, column, "expected a number, found nothing"));
        }
        number_in(cell).map_err(|message| self.error_in(row.line, column, message))
    }

    /// `file:line: message`.
    pub fn error(&self, line: u64, message: impl std::fmt::Display) -> Error {
        anyhow!("{}: {message}", self.place(line))
    }

    /// `file:line`.
    pub fn place(&self, line: u64) -> String {
        format!("{}:{line}", self.file)
    }

    /// `file:line: column 3 (EyeBlinkLeft): message`; columns count from 0 here and from 1 in the message.
    pub fn error_in(&self, line: u64, column: usize, message: impl std::fmt::Display) -> Error {
        let name = self.header.get(column).map_or_else(String::new, |name| format!(" ({})", name.escape_debug()));
        self.error(line, format!("column {}{name}: {message}", column + 1))
    }
}
