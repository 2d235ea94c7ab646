//! Tests of the exports.

mod spreadsheets;
