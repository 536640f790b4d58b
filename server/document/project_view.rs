//! The files of a project at one moment, as one of them sees them.

use super::Document;
use std::sync::atomic::{AtomicBool, Ordering};

/// A file of a project.
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    /// Its path from the project's folder with `/` between the parts, for people; empty for a text that stands alone.
    pub name: &'a str,
    /// What it says: the editor's text if it is open there, else that of the disk.
    pub document: &'a Document,
}

/// The files of a project in the order of execution, and which of them is looked at.
///
/// The number of a member is the key by which answers name a file; whoever made the view knows where it lies.
#[derive(Clone, Debug)]
pub struct ProjectView<'a> {
    members: Vec<Member<'a>>,
    here: usize,
    is_listed: bool,
    cancelled: Option<&'a AtomicBool>,
}

/// A place in a file of a project.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct At<T> {
    /// The number of the file in its [`ProjectView`].
    pub file: usize,
    /// What is there.
    pub value: T,
}

impl<'a> ProjectView<'a> {
    /// A document without others.
    pub fn alone(document: &'a Document) -> ProjectView<'a> {
        ProjectView {
            members: vec![Member { name: "", document }],
            here: 0,
            is_listed: false,
            cancelled: None,
        }
    }

    /// The files `members`, seen from number `here`; nothing if there is no such number. `is_listed` says that the
    /// manifest lists them and they are not just all files of the folder.
    pub fn new(members: Vec<Member<'a>>, here: usize, is_listed: bool) -> Option<ProjectView<'a>> {
        (here < members.len()).then_some(ProjectView { members, here, is_listed, cancelled: None })
    }

    /// Whether the manifest lists the files.
    pub fn is_listed(&self) -> bool {
        self.is_listed
    }

    /// The document that is looked at.
    pub fn here(&self) -> &'a Document {
        self.members[self.here].document
    }

    /// Its number.
    pub fn here_number(&self) -> usize {
        self.here
    }

    /// All files, the one looked at among them.
    pub fn members(&self) -> &[Member<'a>] {
        &self.members
    }

    /// All files but the one looked at, with their numbers.
    pub fn others(&self) -> impl Iterator<Item = (usize, Member<'a>)> + '_ {
        self.members.iter().copied().enumerate().filter(|(number, _)| *number != self.here)
    }

    /// The same files seen from another one; from the same one if there is no such number.
    pub fn from(&self, here: usize) -> ProjectView<'a> {
        let here = if here < self.members.len() { here } else { self.here };
        ProjectView { members: self.members.clone(), here, ..self.clone() }
    }

    /// The file that is looked at without the others.
    pub fn alone_here(&self) -> ProjectView<'a> {
        ProjectView { members: vec![self.members[self.here]], here: 0, ..self.clone() }
    }

    /// The same view for work that nobody waits for any more once `flag` is set.
    pub fn cancellable(mut self, flag: &'a AtomicBool) -> ProjectView<'a> {
        self.cancelled = Some(flag);
        self
    }

    /// The flag that says so.
    pub fn cancelled(&self) -> Option<&'a AtomicBool> {
        self.cancelled
    }

    /// Whether nobody waits for the answer any more, so that any answer is as good as the right one.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}
