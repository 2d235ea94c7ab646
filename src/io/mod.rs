//! Case files, schema, results, pictures, checkpoints.
