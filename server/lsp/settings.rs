//! The client's settings: the same shape in `initializationOptions` and in `didChangeConfiguration`.

use crate::document::Notation;
use crate::ide::Style;
use crate::project::{FormatStyle, Manifest};
use crate::target::Target;
use serde::Deserialize;

/// What the user set in the editor. Everything may be left out.
#[derive(Clone, PartialEq, Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Settings {
    /// `fx2n` …; empty or `auto` leaves it to the project and the content.
    pub target: Option<String>,
    /// `fx`, `iec`; empty or `auto` leaves it to the project and the content.
    pub dialect: Option<String>,
    pub format: Format,
    pub inlay_hints: InlayHints,
    pub diagnostics: Diagnostics,
}

#[derive(Clone, PartialEq, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Format {
    pub style: Option<String>,
    pub width: Option<u32>,
}

#[derive(Clone, PartialEq, Debug, Deserialize)]
#[serde(default)]
pub(super) struct InlayHints {
    pub enabled: bool,
}

impl Default for InlayHints {
    fn default() -> InlayHints {
        InlayHints { enabled: true }
    }
}

#[derive(Clone, PartialEq, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Diagnostics {
    /// `push` (the default) or `pull`. A client that shows both kinds would show everything twice.
    pub mode: Option<String>,
}

impl Settings {
    /// From `initializationOptions`, or from the `settings` of `didChangeConfiguration`, where the part under
    /// `rungwise` counts. What cannot be read is ignored, as no user can see an answer to a notification.
    pub(super) fn read(value: Option<&serde_json::Value>) -> Settings {
        let Some(value) = value else { return Settings::default() };
        let own = value.get("rungwise").unwrap_or(value);
        serde_json::from_value(own.clone()).unwrap_or_else(|reason| {
            tracing::warn!("settings could not be read: {reason}");
            Settings::default()
        })
    }

    pub(super) fn target(&self) -> Option<&'static Target> {
        self.target.as_deref().and_then(Target::named)
    }

    pub(super) fn notation(&self) -> Option<Notation> {
        match self.dialect.as_deref() {
            Some("fx") => Some(Notation::FxIl),
            Some("iec") => Some(Notation::IecIl),
            _ => None,
        }
    }

    pub(super) fn style(&self, manifest: &Manifest) -> Style {
        let kind = match self.format.style.as_deref() {
            Some("iec") => FormatStyle::Iec,
            Some("brackets") => FormatStyle::Brackets,
            Some("unicode") => FormatStyle::Unicode,
            _ => manifest.format.style,
        };
        Style { kind, width: self.format.width.unwrap_or(manifest.format.width) }
    }

    pub(super) fn pulls(&self) -> bool {
        self.diagnostics.mode.as_deref() == Some("pull")
    }
}
