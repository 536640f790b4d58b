//! Rungwise.
