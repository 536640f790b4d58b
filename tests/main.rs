//! Every test of the package that needs no private item, one module for each subject.

mod target_iec;
