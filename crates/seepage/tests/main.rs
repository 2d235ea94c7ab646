//! Flow in nets of joints.
