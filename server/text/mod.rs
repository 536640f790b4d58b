//! Plain data about text: spans, edits, positions, diagnostics and the message catalogue.
//!
//! Nothing here knows a protocol, a file or a PLC.

mod case;
pub use case::folded;

mod csv;
pub use csv::csv_line;

mod span;
pub use span::{Span, Spanned};

mod edit;
pub use edit::TextEdit;

mod position;
pub use position::{
    BYTE_ORDER_MARK, Encoding, LineColumn, cell_width, column_of_offset, offset_of_column, position_of,
    text_width,
};

mod message;
pub use message::{Language, Message, catalogue_keys, list_separator};

mod translation;
pub use translation::{Book, EXAMPLE, has_phrase, page, phrase, phrases, prose, sections};

mod diagnostic;
pub use diagnostic::{Diagnostic, Fix, Related, Severity};
