//! Every test of the package that needs no private item, one module for each subject.

mod il_iec;
mod rules;
mod target_fx;
mod target_fx_applied;
mod tidy;
