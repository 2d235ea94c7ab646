//! FMI 2 co-simulation entry points over `enmm_fmi`.
