//! Characters of which drawings are made, by the directions in which their lines run.

/// The directions in which a character's lines run; no direction for characters that draw no line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Arms(u8);

const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const UP: u8 = 4;
const DOWN: u8 = 8;

/// The arms of U+2500 to U+257F, one hexadecimal digit each, from the Unicode names ("DOWN AND RIGHT" …).
const BOX_DRAWING: &[u8; 128] = b"33cc33cc33ccaaaa999966665555eeeeeeeeddddddddbbbbbbbb77777777ffff\
    ffffffffffff33cc3caaa999666555eeedddbbb777fffa956000142814283c3c";

/// The arms of the ASCII characters: every cell of a drawing is asked for them many times.
const ASCII: [u8; 128] = {
    let mut arms = [0; 128];
    arms[b'-' as usize] = LEFT | RIGHT;
    arms[b'_' as usize] = LEFT | RIGHT;
    arms[b'=' as usize] = LEFT | RIGHT;
    arms[b'|' as usize] = UP | DOWN;
    arms[b'!' as usize] = UP | DOWN;
    arms[b'+' as usize] = LEFT | RIGHT | UP | DOWN;
    arms[b'*' as usize] = LEFT | RIGHT | UP | DOWN;
    arms
};

impl Arms {
    /// The arms of `character`. `+` and `*` run in all four directions.
    pub(super) const fn of(character: char) -> Arms {
        Arms(match character {
            '\0'..='\x7F' => ASCII[character as usize & 0x7F],
            '\u{2500}'..='\u{257F}' => {
                let digit = BOX_DRAWING[(character as usize - 0x2500) & 0x7F];
                if digit <= b'9' { digit - b'0' } else { digit - b'a' + 10 }
            }
            _ => 0,
        })
    }

    /// A wire: only to the left and right.
    pub(super) const fn is_horizontal(self) -> bool {
        self.0 != 0 && self.0 & (UP | DOWN) == 0
    }

    /// A bar: only up and down.
    pub(super) fn is_vertical(self) -> bool {
        self.0 != 0 && self.0 & (LEFT | RIGHT) == 0
    }

    /// A corner, a branch or a connected crossing.
    pub(super) const fn is_junction(self) -> bool {
        self.0 & (UP | DOWN) != 0 && self.0 & (LEFT | RIGHT) != 0
    }

    /// Draws a line at all.
    pub(super) fn is_line(self) -> bool {
        self.0 != 0
    }

    /// Runs up, to the cell above.
    pub(super) fn up(self) -> bool {
        self.0 & UP != 0
    }

    /// Runs down, to the cell below.
    pub(super) fn down(self) -> bool {
        self.0 & DOWN != 0
    }

    /// `┤`: a bar with a wire on its left only.
    pub(super) fn is_left_tee(self) -> bool {
        self.0 == UP | DOWN | LEFT
    }

    /// `├`: a bar with a wire on its right only.
    pub(super) fn is_right_tee(self) -> bool {
        self.0 == UP | DOWN | RIGHT
    }

    /// A bar or a junction: part of a vertical wire.
    pub(super) fn is_upright(self) -> bool {
        self.0 & (UP | DOWN) != 0
    }
}

/// What a character between two bars or brackets makes of a contact; a blank for a normally open one.
pub(super) fn contact_mark(character: char) -> Option<super::ContactKind> {
    use super::ContactKind::*;
    Some(match character {
        ' ' => NormallyOpen,
        '/' | '\\' => NormallyClosed,
        'P' | 'p' | '↑' => Rising,
        'N' | 'n' | '↓' => Falling,
        _ => return None,
    })
}

/// The directions in which a character's lines run.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Strokes {
    /// To the cell on the left.
    pub left: bool,
    /// To the cell on the right.
    pub right: bool,
    /// To the cell above.
    pub up: bool,
    /// To the cell below.
    pub down: bool,
}

impl Strokes {
    /// The strokes of `character`; none if it draws no line. `+` and `*` run in all four directions.
    pub fn of(character: char) -> Strokes {
        let Arms(arms) = Arms::of(character);
        let has = |arm: u8| arms & arm != 0;
        Strokes { left: has(LEFT), right: has(RIGHT), up: has(UP), down: has(DOWN) }
    }
}

/// Whether a word may start with `character`: names, devices, numbers, `%` addresses, quoted text.
pub(super) fn starts_word(character: char) -> bool {
    if character.is_ascii() { starts_ascii_word(character) } else { character.is_alphanumeric() }
}

/// The same of an ASCII character, for tables; false for others.
pub(super) const fn starts_ascii_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || matches!(character, '%' | '\'' | '"' | '#' | '$' | '@')
}

/// Whether a word goes on with `character`.
pub(super) fn continues_word(character: char) -> bool {
    character.is_alphanumeric() || matches!(character, '_' | '.' | '%' | '#' | '$' | '@' | '~')
}

/// Whether `character` is part of a comparison operator.
pub(super) fn is_operator(character: char) -> bool {
    matches!(character, '<' | '>' | '=' | '!' | '≥' | '≤' | '≠')
}
