//! The list of used devices: gaps, kinds and parts of it, through the functions, the command line and the server.

use super::lsp_client::Client;
use rungwise::document::{Document, Member, Notation, ProjectView};
use rungwise::ide::{self, Usage, UsageOf, UsageRow, UsageWish};
use rungwise::target::{Model, Target};
use rungwise::text::Language;
use serde_json::{Value, json};
use std::process::Command;

fn fx(text: &str) -> Document {
    Document::new(text, Notation::FxIl, Target::of(Model::Fx2n))
}

fn gaps(row: &UsageRow) -> String {
    let one = |(first, last): &(rungwise::target::Device, _)| format!("{first}..{last}");
    row.gaps.iter().map(one).collect::<Vec<_>>().join(" ")
}

fn all_gaps(usage: &Usage) -> Vec<String> {
    let rows = usage.rows.iter().filter(|row| !row.gaps.is_empty());
    rows.map(|row| format!("{} {}", row.name, gaps(row))).collect()
}

#[test]
fn gaps_are_the_unused_numbers_between_used_ones() {
    // K1M4 means M4 to M7, DMOV D4 and D5; numbers of inputs are octal.
    let document = fx("LD X6\nAND X11\nOUT M1\nMOV K1M4 D0\nDMOV D2 D4\nLD M9\nOUT M12\nEND\n");
    let usage = ide::usage(&ProjectView::alone(&document));
    assert_eq!(all_gaps(&usage), ["X6 X7..X10", "M1 M2..M3", "M4 M8..M8", "M9 M10..M11", "D0 D1..D1"]);
    let kinds: Vec<String> = usage
        .kinds
        .iter()
        .map(|kind| format!("{} {} {}", kind.kind.word(), kind.used, kind.next.unwrap()))
        .collect();
    assert_eq!(kinds, ["X 2 X0", "M 7 M0", "D 5 D1"]);
}

#[test]
fn gaps_end_at_the_ends_of_ranges_and_have_none_of_the_special_devices() {
    // M499 is the last general relay, M500 the first latched one; P63 is the pointer to END.
    let text = "LD M497\nAND M502\nAND M8000\nAND M8013\nOUT M505\nCJ P61\nCJ P64\nLD X0\nMC N0 M0\nMCR N0\n\
                P61\nP64\nEND\n";
    let usage = ide::usage(&ProjectView::alone(&fx(text)));
    assert_eq!(all_gaps(&usage), ["M0 M1..M496", "M502 M503..M504"]);
    let pointers = usage.kinds.iter().find(|kind| kind.kind.word() == "P").unwrap();
    assert_eq!(pointers.next.unwrap().to_string(), "P0");
    let nesting = usage.kinds.iter().find(|kind| kind.kind.word() == "N").unwrap();
    assert_eq!((nesting.used, nesting.next), (1, None));
}

#[test]
fn all_files_of_a_project_fill_gaps() {
    let (main, pump) = (fx("LD M0\nOUT M4\n"), fx("LD M2\nOUT Y0\nEND\n"));
    let members =
        vec![Member { name: "main.il", document: &main }, Member { name: "pump.il", document: &pump }];
    let usage = ide::usage(&ProjectView::new(members, 0, true).unwrap());
    assert_eq!(all_gaps(&usage), ["M0 M1..M1", "M2 M3..M3"]);
}

#[test]
fn the_page_tells_gaps_below_each_grid() {
    let document = fx("LD M0\nAND M3\nOUT M5\nLD X0\nOUT Y0\nEND\n");
    let view = ProjectView::alone(&document);
    let page = ide::usage(&view).text(&view, Language::English);
    assert!(page.contains("\nfree in between: M1–M2, M4; next free: M1\n"), "{page}");
    assert!(page.contains("\nnext free: X1\n"), "{page}");
    let many: String = (0..40).map(|number| format!("LD M{}\nOUT Y0\n", number * 2)).collect();
    let document = fx(&many);
    let view = ProjectView::alone(&document);
    let page = ide::usage(&view).text(&view, Language::English);
    assert!(page.contains("M29, M31, 23 more; next free: M1\n"), "{page}");
}

#[test]
fn parts_of_the_list_are_as_in_the_whole() {
    let text = "PROGRAM Main\nVAR\n a AT %IX0.0 : BOOL;\n b : BOOL;\nEND_VAR\nLD a\nST b\nEND_PROGRAM\n\
                PROGRAM Two\nVAR\n a : BOOL;\nEND_VAR\nLD a\nEND_PROGRAM\n";
    let document = Document::new(text, Notation::IecIl, Target::of(Model::Iec));
    let view = ProjectView::alone(&document);
    let whole = ide::usage(&view);
    let part = |of| ide::usage_of(&view, &UsageWish { places: true, of }).rows;
    assert_eq!(
        part(UsageOf::Named(vec!["main.A".into(), "%ix0.0".into()])),
        [&whole.rows[0], &whole.rows[1]].map(Clone::clone)
    );
    assert_eq!(part(UsageOf::Named(vec!["a".into()])), []);
    assert_eq!(part(UsageOf::At(text.rfind("LD a").unwrap() + 3)), [whole.rows[3].clone()]);
    assert_eq!(part(UsageOf::At(text.find("PROGRAM").unwrap())), []);
    let counted = ide::usage_of(&view, &UsageWish { places: false, of: UsageOf::All });
    assert_eq!(counted.kinds, whole.kinds);
    for (counted, whole) in counted.rows.iter().zip(&whole.rows) {
        assert_eq!(*counted, UsageRow { uses: Vec::new(), ..whole.clone() });
        let count = |is: fn(&ide::UsageAt) -> bool| whole.uses.iter().filter(|at| is(at)).count();
        assert_eq!(
            (counted.reads, counted.writes),
            (count(|at| at.usage.reads()), count(|at| at.usage.writes()))
        );
    }
}

#[test]
fn devices_with_a_comment_are_not_free() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("rungwise.toml", "target = \"fx2n\"\ncomments = \"devices.csv\"\n"),
        ("devices.csv", "M0;Spare;\nM3;;kept for the press\n"),
        ("a.il", "LD M1\nOUT M6\nEND\n"),
    ];
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungwise"));
    let output = command.args(["usage", "--format", "json"]).current_dir(folder.path()).output().unwrap();
    let project = &serde_json::from_slice::<Value>(&output.stdout).unwrap()["projects"][0];
    let gaps = json!([{"first": "M2", "last": "M2", "count": 1}, {"first": "M4", "last": "M5", "count": 2}]);
    assert_eq!(project["devices"][0]["gaps"], gaps);
    assert_eq!(project["kinds"][0]["next"], "M2");
}

#[test]
fn gaps_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.il"), "LD X0\nAND X3\nOUT Y0\nEND\n").unwrap();
    let run = |format: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rungwise"));
        let output = command.args(["usage", "a.il", "--format", format]).current_dir(folder.path()).output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    };
    let rows = run("csv");
    assert!(rows.lines().nth(1).unwrap().ends_with("a.il:1:read,X1-X2"), "{rows}");
    assert!(rows.lines().nth(2).unwrap().ends_with("a.il:2:read,"), "{rows}");
    let project = &serde_json::from_str::<Value>(&run("json")).unwrap()["projects"][0];
    assert_eq!(project["devices"][0]["gaps"], json!([{"first": "X1", "last": "X2", "count": 2}]));
    assert_eq!(project["kinds"][0], json!({"kind": "X", "name": "input relay", "used": 2, "next": "X1"}));
}

#[test]
fn the_command_answers_what_is_asked() {
    let mut client = Client::start();
    let uri = "file:///rungwise-usage/a.il";
    client.open(uri, "plc-il", "LD X0\nAND X3\nOUT Y0\nLD X0\nOUT Y1\nEND\n");
    let mut ask = |options: Value| {
        let params = json!({"command": "rungwise.usage", "arguments": [uri, options]});
        client.request("workspace/executeCommand", params)
    };
    let counted = ask(json!({"text": false, "uses": false}))["result"].clone();
    assert!(counted.get("text").is_none(), "{counted}");
    let x0 = &counted["devices"][0];
    assert_eq!((&x0["reads"], &x0["writes"], x0.get("uses")), (&json!(2), &json!(0), None));
    assert_eq!(counted["kinds"][1]["kind"], "Y");
    let named = ask(json!({"devices": ["x3"]}))["result"].clone();
    assert!(named.get("text").is_none(), "{named}");
    assert_eq!(named["devices"].as_array().unwrap().len(), 1);
    assert_eq!(named["devices"][0]["uses"][0]["line"], 2);
    let here = ask(json!({"position": {"line": 3, "character": 4}}))["result"].clone();
    assert_eq!(here["devices"][0]["device"], "X0");
    assert_eq!(here["devices"][0]["uses"].as_array().unwrap().len(), 2);
    assert_eq!(ask(json!({"position": {"line": 5, "character": 1}}))["result"]["devices"], json!([]));
    assert!(ask(json!({"devices": 3}))["error"]["message"].as_str().unwrap().contains("rungwise.usage"));
    assert!(ask(Value::Null)["result"]["text"].as_str().unwrap().contains("X0"));
}
