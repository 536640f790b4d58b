//! The JSON schema of `rungwise.toml` that the extension ships says what the manifest's reader takes, no more, no less.

use rungwise::check::RULES;
use rungwise::project::{MOST_WIDTH, Manifest};
use rungwise::text::Language;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

fn schema() -> Value {
    serde_json::from_str(include_str!("../vscode-extension/schemas/rungwise.schema.json")).unwrap()
}

fn properties(schema: &Value) -> &Map<String, Value> {
    schema["properties"].as_object().unwrap()
}

fn words(list: &Value) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect()
}

/// What the reader says about a manifest that it refuses.
fn refusal(manifest: &str) -> String {
    Manifest::read(manifest).unwrap_err().message.render(Language::English)
}

/// The keys that the reader knows in a table, from what it says about one that it does not know.
fn keys_read(manifest: &str) -> BTreeSet<String> {
    let said = refusal(manifest);
    let (_, list) = said.split_once("there are ").unwrap_or_else(|| panic!("{said}"));
    list.split(", ").map(str::to_string).collect()
}

fn keys(schema: &Value) -> BTreeSet<String> {
    properties(schema).keys().cloned().collect()
}

#[test]
fn every_table_has_the_keys_that_are_read() {
    let schema = schema();
    assert_eq!(keys(&schema), keys_read("zzz = 1"));
    assert_eq!(keys(&schema["properties"]["format"]), keys_read("[format]\nzzz = 1"));
    for table in ["check", "monitor", "plc", "simulate", "translate"] {
        assert_eq!(keys(&schema["properties"][table]), keys_read(&format!("[{table}]\nzzz = 1")));
        assert_eq!(schema["properties"][table]["additionalProperties"], Value::Bool(false));
    }
    let task = &schema["properties"]["task"]["items"];
    assert_eq!(keys(task), keys_read("[[task]]\nname = ''\nprograms = []\nzzz = 1"));
    let alarm = &schema["properties"]["alarm"]["items"];
    assert_eq!(keys(alarm), keys_read("[[alarm]]\nwhen = 'X0'\nmessage = ''\nzzz = 1"));
    for required in words(&alarm["required"]) {
        let rest = if required == "when" { "message = ''" } else { "when = 'X0'" };
        assert!(refusal(&format!("[[alarm]]\n{rest}")).contains(required));
    }
    for required in words(&task["required"]) {
        let rest = if required == "name" { "programs = []" } else { "name = ''" };
        assert!(refusal(&format!("[[task]]\n{rest}")).contains(required));
    }
    for table in [&schema, &schema["properties"]["format"], &schema["properties"]["rules"], task, alarm] {
        assert_eq!(table["additionalProperties"], Value::Bool(false));
    }
}

#[test]
fn what_is_wrong_is_said_in_the_language_of_the_user() {
    for (manifest, english, chinese) in [
        (
            "[format]\nstile = 1",
            "there is no key `stile` here; there are style, width",
            "此处没有键 `stile`；可用的键：style、width",
        ),
        (
            "[format]\nstyle = \"box\"",
            "`box` is not taken here; iec, brackets, unicode are",
            "此处不接受 `box`；可用 iec、brackets、unicode",
        ),
        ("[[task]]\nname = \"a\"", "the key `programs` is missing here", "此处缺少键 `programs`"),
        ("[format]\nwidth = \"a\"", "a whole number belongs here", "此处应为整数"),
        ("[format]\nwidth = -1", "a whole number belongs here", "此处应为整数"),
        ("target = 7", "text in quotes belongs here", "此处应为带引号的文本"),
        ("files = \"a.il\"", "a list in brackets belongs here", "此处应为方括号中的列表"),
        ("rules = 1", "a table belongs here", "此处应为表"),
        ("format = 1", "a table belongs here", "此处应为表"),
        (
            "[translate]\ntarget = \"iec\"",
            "`iec` is no model of the FX family; fx1s, fx1n, fx2n and fx3u are",
            "`iec` 不是 FX 系列的型号；可用 fx1s、fx1n、fx2n 和 fx3u",
        ),
    ] {
        let message = Manifest::read(manifest).unwrap_err().message;
        assert_eq!(message.render(Language::English), english);
        assert_eq!(message.render(Language::SimplifiedChinese), chinese);
    }
}

#[test]
fn every_word_of_the_schema_is_read_and_others_are_not() {
    let schema = schema();
    for (key, manifest) in [
        ("/properties/target", "target = \"WORD\""),
        ("/properties/dialect", "dialect = \"WORD\""),
        ("/properties/format/properties/style", "[format]\nstyle = \"WORD\""),
        ("/definitions/severity", "[rules]\nopen-circuit = \"WORD\""),
        (
            "/properties/alarm/items/properties/severity",
            "[[alarm]]\nwhen = \"X0\"\nmessage = \"\"\nseverity = \"WORD\"",
        ),
    ] {
        for word in words(&schema.pointer(key).unwrap()["enum"]) {
            assert!(Manifest::read(&manifest.replace("WORD", word)).is_ok(), "{key}: {word}");
        }
        assert!(Manifest::read(&manifest.replace("WORD", "zzz")).is_err(), "{key}");
    }
    // A target that is named in no schema would be flagged in a manifest that works.
    let targets = words(&schema["properties"]["target"]["enum"]);
    for model in ["fx1s", "fx1n", "fx2n", "fx3u", "iec", "fx5u", "fx0", "fx3g"] {
        let read = Manifest::read(&format!("target = \"{model}\"")).is_ok();
        assert_eq!(targets.contains(&model), read, "{model}");
        let lists = words(&schema["properties"]["translate"]["properties"]["target"]["enum"]);
        let read = Manifest::read(&format!("[translate]\ntarget = \"{model}\"")).is_ok();
        assert_eq!(lists.contains(&model), read, "{model}");
    }
    let width = |width: u64| Manifest::read(&format!("[format]\nwidth = {width}")).is_ok();
    let most = schema["properties"]["format"]["properties"]["width"]["maximum"].as_u64().unwrap();
    assert_eq!(most, u64::from(MOST_WIDTH));
    assert!(width(most) && !width(most + 1));
    let record = |changes: u64| Manifest::read(&format!("[monitor]\nrecord = {changes}")).is_ok();
    let kept = &schema["properties"]["monitor"]["properties"]["record"];
    let [least, most] = ["minimum", "maximum"].map(|end| kept[end].as_u64().unwrap());
    assert!(record(least) && record(most) && !record(least - 1) && !record(most + 1));
}

#[test]
fn the_size_of_a_history_is_read_as_the_schema_says_it() {
    let schema = schema();
    let history = &schema["properties"]["simulate"]["properties"]["history"];
    let read = |word: &str| Manifest::read(&format!("[simulate]\nhistory = \"{word}\""));
    let own = |word: &str| read(word).unwrap().history().to_string();
    assert_eq!(own(history["default"].as_str().unwrap()), Manifest::default().history().to_string());
    words(&history["examples"]).into_iter().for_each(|word| assert_eq!(own(word), word));
    assert_eq!(own(" 2048kib "), "2 MiB");
    assert_eq!(own("1MiB"), "1 MiB");
    for word in
        ["", "64", "64 MB", "MiB", "-1 MiB", "1.5 MiB", "1023 KiB", "17 GiB", "99999999999999999999 GiB"]
    {
        let error = read(word).unwrap_err();
        let said = error.message.render(Language::English);
        assert!(said.starts_with(&format!("`{word}` is no size of a history; write 64 MiB")), "{said}");
        assert_eq!(error.span.start, 22, "behind the quote: {error:?}");
    }
}

/// With the environment variable `UPDATE_EXPECT` set, the rules of the schema are written anew.
#[test]
fn every_rule_is_there_with_its_sentence() {
    let mut schema = schema();
    let rules: Map<String, Value> = RULES
        .iter()
        .map(|rule| {
            let severity = json!([{"$ref": "#/definitions/severity"}]);
            (
                rule.code.to_string(),
                json!({"allOf": severity, "description": rule.summary(Language::English)}),
            )
        })
        .collect();
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        schema["properties"]["rules"]["properties"] = Value::Object(rules.clone());
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/vscode-extension/schemas/rungwise.schema.json");
        std::fs::write(path, serde_json::to_string_pretty(&schema).unwrap() + "\n").unwrap();
    }
    assert_eq!(properties(&schema["properties"]["rules"]), &rules, "UPDATE_EXPECT=1 writes them anew");
}

#[test]
fn the_examples_of_the_schema_are_read() {
    let schema = schema();
    let mut count = 0;
    for (key, property) in properties(&schema) {
        for example in property["examples"].as_array().into_iter().flatten() {
            let manifest = toml::to_string(&json!({ key: example })).unwrap();
            assert!(Manifest::read(&manifest).is_ok(), "{manifest}");
            count += 1;
        }
    }
    assert!(count >= 7);
}
