//! The page of a row: one paragraph and a complete example program.

/// What a page says, apart from the frame that all pages share.
#[derive(Debug)]
pub(super) struct Page {
    /// One paragraph of Markdown.
    pub about: &'static str,
    /// The declarations of the example's `VAR` section, one a line, without the `;`.
    pub variables: &'static [&'static str],
    /// The instructions, one a line; further lines of a parameter list are indented by four blanks.
    pub body: &'static [&'static str],
}

impl Page {
    /// The Markdown of the page: the paragraph, then a fenced `il` program in canonical form.
    pub fn markdown(&self) -> String {
        markdown(self.about, self.variables, self.body)
    }
}

/// The frame of every page, also of those that are made from a pattern.
pub(super) fn markdown<S: AsRef<str>>(about: &str, variables: &[S], body: &[S]) -> String {
    let mut page = format!("{about}\n\n```il\nPROGRAM Example\nVAR\n");
    for variable in variables {
        page.push_str("    ");
        page.push_str(variable.as_ref());
        page.push_str(";\n");
    }
    page.push_str("END_VAR\n");
    for line in body {
        // A label stands at the margin, as a label of a rung does.
        if !line.as_ref().ends_with(':') {
            page.push_str("    ");
        }
        page.push_str(line.as_ref());
        page.push('\n');
    }
    page.push_str("END_PROGRAM\n```\n");
    page
}
