//! The pairs of lines that a DXF file is made of: a code and a value.

use crate::case_error::{CaseError, shown};
use enmm::model::case::key::Key;

/// One pair of lines.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Meaning of the value.
    pub code: i32,
    /// The value.
    pub value: &'a str,
    /// Line of the value, counted from 1.
    pub line: usize,
}

/// All pairs of a file.
pub struct Groups<'a> {
    /// The file as the user named it.
    pub file: &'a str,
    /// The pairs in order.
    pub all: Vec<Group<'a>>,
}

impl<'a> Groups<'a> {
    /// Splits a file into pairs, up to `EOF`.
    ///
    /// # Errors
    /// A code is no whole number, or the last pair has no value.
    pub fn parse(file: &'a str, text: &'a str) -> Result<Self, CaseError> {
        let mut groups = Self { file, all: Vec::new() };
        let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
        while let Some((line, code)) = lines.next() {
            let Ok(code) = code.parse() else {
                if code.is_empty() && lines.all(|(_, rest)| rest.is_empty()) {
                    break;
                }
                let is_drawing = groups.all.first().is_some_and(|group| group.code == 999 || group.value == "SECTION");
                let code = shown(code, is_drawing);
                return groups.syntax(line, format!("{code} is no group code of DXF, a whole number; save it again"));
            };
            let Some((line, value)) = lines.next() else {
                return groups.syntax(line, format!("the value of group {code} is missing; the file is cut off"));
            };
            groups.all.push(Group { code, value, line });
            if (code, value) == (0, "EOF") {
                break;
            }
        }
        Ok(groups)
    }

    /// Returns the error that a line is not DXF.
    ///
    /// # Errors
    /// Always.
    pub fn syntax<T>(&self, line: usize, message: String) -> Result<T, CaseError> {
        Err(CaseError::at(self.file, line, "", message))
    }

    /// Returns the error at an entity.
    ///
    /// # Errors
    /// Always.
    pub fn fail<T>(&self, line: usize, key: &Key, message: String) -> Result<T, CaseError> {
        Err(CaseError::at(self.file, line, key.as_str(), message))
    }

    /// Returns the error that an entity lacks a pair.
    ///
    /// # Errors
    /// Always.
    pub fn missing<T>(&self, line: usize, kind: &str, code: i32) -> Result<T, CaseError> {
        self.syntax(line, format!("{kind} has no group {code}; the file is damaged, save it again"))
    }

    /// Returns the number that a pair has.
    ///
    /// # Errors
    /// It is no number.
    pub fn number(&self, group: &Group) -> Result<f64, CaseError> {
        let bad =
            |_| self.syntax(group.line, format!("{:?} of group {} is no number; correct it", group.value, group.code));
        group.value.parse().or_else(bad)
    }

    /// Returns the whole number under a code, 0 if it is not given.
    ///
    /// # Errors
    /// It is no whole number.
    pub fn whole(&self, record: &[Group], code: i32) -> Result<i64, CaseError> {
        let Some(group) = record.iter().find(|group| group.code == code) else { return Ok(0) };
        let bad =
            |_| self.syntax(group.line, format!("{:?} of group {code} is no whole number; correct it", group.value));
        group.value.parse().or_else(bad)
    }
}
