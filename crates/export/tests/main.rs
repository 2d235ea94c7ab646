//! Tests of the exports.

mod slopes;
mod spreadsheets;
