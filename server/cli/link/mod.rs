//! The verbs that speak with a PLC over a line.

mod connection;
pub(super) use connection::Connection;

mod contents;

pub(super) mod control;

pub(super) mod devices;

pub(super) mod download;

mod drift;

pub(super) mod monitor;

pub(super) mod ports;

pub(super) mod status;

pub(super) mod upload;

pub(super) mod verify;
