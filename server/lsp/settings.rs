//! The client's settings: the same shape in `initializationOptions` and in `didChangeConfiguration`.

use crate::document::Notation;
use crate::ide::{LensSettings, Style};
use crate::project::{FormatStyle, MOST_WIDTH, Manifest};
use crate::target::Target;
use crate::text::Language;
use serde_json::Value;

/// What the user set in the editor. Everything may be left out.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    /// `target`: `fx2n` …; anything else leaves it to the project and the content.
    pub target: Option<&'static Target>,
    /// `dialect`: `fx`, `iec`; anything else leaves it to the project and the content.
    pub notation: Option<Notation>,
    /// `format.style`: `iec`, `brackets`, `unicode`; anything else leaves it to the project.
    style: Option<FormatStyle>,
    /// `format.width`, in cells; else the project's.
    width: Option<u32>,
    /// `language`: `en`, `zh-CN`; anything else leaves it to the client.
    language: Option<Language>,
    /// `inlayHints.enabled`
    pub inlay_hints: bool,
    /// `inlayHints.comments`: what the project says about devices, behind them.
    pub comment_hints: bool,
    /// `codeLens.steps`, `codeLens.references`, `codeLens.nextFree`.
    pub lenses: LensSettings,
    /// `codeLens.run`: what can be done with a program, above its first line.
    pub run_lenses: bool,
    /// `diagnostics.scope` is `project` and not `open`: files of a project that are not open are reported, too.
    pub whole_project: bool,
    /// `diagnostics.mode` is `pull` and not `push`. A client that shows both kinds would show everything twice.
    pub pulls: bool,
}

/// What is known of the user's language apart from the settings.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Speech {
    /// What the command line of the server says.
    pub asked: Option<Language>,
    /// The locale of the client.
    pub client: Option<Language>,
    /// What holds if nobody says anything.
    pub otherwise: Language,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            target: None,
            notation: None,
            style: None,
            width: None,
            language: None,
            inlay_hints: true,
            comment_hints: true,
            lenses: LensSettings { steps: true, references: true, next_free: true },
            run_lenses: true,
            whole_project: true,
            pulls: false,
        }
    }
}

impl Settings {
    /// From `initializationOptions`, or from the `settings` of `didChangeConfiguration`, where the part under
    /// `rungwise` counts; `None` if there are no settings. Each setting is read by itself: one of a wrong kind, and
    /// many clients send `null` for what is not set, does not spoil the others.
    pub(super) fn read(value: Option<&Value>) -> Option<Settings> {
        let value = value?;
        let own = value.get("rungwise").unwrap_or(value).as_object()?;
        let part = |section: &str, name: &str| own.get(section).and_then(|section| section.get(name));
        let word = |value: Option<&Value>| value.and_then(Value::as_str).map(str::to_ascii_lowercase);
        let notation = word(own.get("dialect")).and_then(|word| Notation::of_dialect(&word));
        let style = match word(part("format", "style")).as_deref() {
            Some("iec") => Some(FormatStyle::Iec),
            Some("brackets") => Some(FormatStyle::Brackets),
            Some("unicode") => Some(FormatStyle::Unicode),
            _ => None,
        };
        let is_on = |section, name| part(section, name).and_then(Value::as_bool).unwrap_or(true);
        let language = match word(own.get("language")).as_deref() {
            Some("en") => Some(Language::English),
            Some("zh-cn" | "zh") => Some(Language::SimplifiedChinese),
            _ => None,
        };
        let width = part("format", "width").and_then(Value::as_u64);
        Some(Settings {
            target: word(own.get("target")).and_then(|name| Target::named(&name)),
            notation,
            style,
            width: width.map(|width| width.min(u64::from(MOST_WIDTH)) as u32),
            language,
            inlay_hints: is_on("inlayHints", "enabled"),
            comment_hints: is_on("inlayHints", "comments"),
            lenses: LensSettings {
                steps: is_on("codeLens", "steps"),
                references: is_on("codeLens", "references"),
                next_free: is_on("codeLens", "nextFree"),
            },
            run_lenses: is_on("codeLens", "run"),
            whole_project: word(part("diagnostics", "scope")).as_deref() != Some("open"),
            pulls: word(part("diagnostics", "mode")).as_deref() == Some("pull"),
        })
    }

    pub(super) fn style(&self, manifest: &Manifest) -> Style {
        let width = self.width.unwrap_or(manifest.format.width);
        Style { kind: self.style.unwrap_or(manifest.format.style), width }
    }

    /// The language of all messages.
    pub(super) fn language(&self, speech: Speech) -> Language {
        self.language.or(speech.asked).or(speech.client).unwrap_or(speech.otherwise)
    }

    /// Whether the same text is the same program with both.
    pub(super) fn reads_like(&self, other: &Settings) -> bool {
        let name = |settings: &Settings| settings.target.map(|target| target.name);
        (name(self), self.notation) == (name(other), other.notation)
    }
}
