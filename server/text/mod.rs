//! Plain data about text: spans, edits, positions, diagnostics and the message catalogue.
//!
//! Nothing here knows a protocol, a file or a PLC.

mod span;
pub use span::{Span, Spanned};

mod edit;
pub use edit::TextEdit;

mod position;
pub use position::{Encoding, LineColumn, cell_width, column_of_offset, offset_of_column};

mod message;
pub use message::{Language, Message, catalogue_keys, list_separator};

mod translation;
pub use translation::{Book, EXAMPLE, has_phrase, page, phrase, phrases, prose, sections};

mod diagnostic;
pub use diagnostic::{Diagnostic, Fix, Related, Severity};
