//! The two texts of LDmicro: its export as a drawing, and its own file.
//!
//! Facts are from the program's own sources (release 5.4.1.1): a position of the grid is 17 cells by 3 rows, names in
//! the first row, symbols on the wire in the second. Symbols of two rows have their upper half in the row of names.

mod boxes;
pub(super) use boxes::find_boxes;

mod meaning;
pub use meaning::{BoxKind, time_literal};

mod table;
pub use table::{NameKind, TableRow, table_rows};
pub(super) use table::{is_row, is_title};

mod native;
pub use native::Note;

mod names;

mod carry;

mod import;
pub use import::{Import, ImportError, import};
