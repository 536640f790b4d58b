//! Ladder diagrams drawn in characters: text to graph, and graph to canonical text.
//!
//! Data takes one way: [`split`] cuts a document into chunks, [`parse`] reads a chunk as a grid of cells, the cells
//! as elements and wires, and these as the [`Graph`] of each rung. [`reduce`](reduce::reduce) turns a graph into the
//! series-parallel [`Shape`](reduce::Shape) that the printer draws. IL is unknown here.

mod chunks;
pub use chunks::{ChunkKind, chunk_ends, kind_of, split};

mod reader;
pub use reader::{Choice, parse, parse_choosing, parse_with};

mod lines;
pub use lines::{column_after, column_of};

mod glyph;
pub use glyph::Strokes;

mod grid;

mod beside;

mod frame;

mod inline;

mod blocks;

mod ldmicro;
pub use ldmicro::{BoxKind, Import, ImportError, NameKind, Note, TableRow, import, table_rows, time_literal};

mod scan;

mod content;
pub use content::coil_words;

mod uprights;

mod ragged;
pub use ragged::TWO_READINGS;

mod wires;

mod names;

mod habit;
pub use habit::habit_of;

mod rungs;

mod element;
pub use element::{
    Block, CoilKind, CompareOperator, ContactKind, Element, ElementId, ElementKind, OperandPlace, Pin,
    PinWire,
};

mod graph;
pub use graph::{Arc, ArcId, Graph, Vertex, VertexId, VertexKind};

mod tree;
pub use tree::{LadderTree, Mention, NameHabit, NetworkHeader, Rung};

mod contract;

pub mod reduce;

mod isomorphism;

mod symbol;

mod layout;

mod canvas;

mod printer;
pub use printer::{Drawing, Style, StyleKind, print};

mod format;
pub use format::{Kept, Page, format, format_chunk, kept_rungs};

mod redraw;
pub use redraw::{redraw, redraw_as};
