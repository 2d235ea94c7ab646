//! Tests of the readers: case files, geometry files, and the reference of keys.

#[path = "../../../tests/common/mod.rs"]
mod common;
mod drawings;
mod errors;
mod expand;
mod geometry_files;
mod issue_a_message_showed_a_line_of_any_file;
mod issue_names_in_geometry_files_were_dropped;
mod issue_units_and_planes_were_believed;
mod issue_values_in_another_unit_were_believed;
mod key_reference;
mod limits;
mod pages;
mod record_formats;
mod records;
mod support;
mod tables;
mod tessellation;
