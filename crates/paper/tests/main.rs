//! Tests of the report on paper.

mod report;
