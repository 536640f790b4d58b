//! What was found in a version of a document, for those who ask again.

use super::workspace::Open;
use crate::text::Diagnostic;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// The findings in a document, and the other files of its project that they were found with.
#[derive(Debug, Default)]
pub(super) struct Known(Mutex<Option<Kept>>);

type Kept = (Vec<Weak<Open>>, Arc<[Diagnostic]>);

impl Clone for Known {
    /// What is made of a document, with another text or among others, is judged anew.
    fn clone(&self) -> Known {
        Known::default()
    }
}

impl Known {
    /// The findings, if they were found among `files`.
    pub fn among(&self, files: &[Arc<Open>]) -> Option<Arc<[Diagnostic]>> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (others, found) = known.as_ref()?;
        let is_same =
            |(other, file): (&Weak<Open>, &Arc<Open>)| std::ptr::eq(other.as_ptr(), Arc::as_ptr(file));
        (others.len() == files.len() && others.iter().zip(files).all(is_same)).then(|| found.clone())
    }

    /// Keeps what was found among `files`.
    pub fn keep(&self, files: &[Arc<Open>], found: &Arc<[Diagnostic]>) {
        // A weak pointer keeps the place of its file from being given to another one.
        let others = files.iter().map(Arc::downgrade).collect();
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((others, found.clone()));
    }
}
