//! FMI 3 co-simulation entry points over `enmm_fmi`.
