//! The JSON schema of scenario tests says what their reader takes, and the server helps with it.

use crate::lsp_client::Client;
use rungwise::scenario::Suite;
use rungwise::text::Language;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::LazyLock;

pub static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../vscode-extension/schemas/scenarios.schema.json")).unwrap()
});

fn keys(table: &Value) -> BTreeSet<String> {
    table["properties"].as_object().unwrap().keys().cloned().collect()
}

/// The keys that the reader knows in a table, from what it says about one that it does not know.
fn keys_read(text: &str) -> BTreeSet<String> {
    let (_, flaws) = Suite::read(text);
    let said = flaws.iter().map(|flaw| flaw.message.render(Language::English));
    let said = said.into_iter().find(|said| said.contains("zzzzzz")).unwrap();
    let (_, list) = said.split_once("there are ").unwrap_or_else(|| panic!("{said}"));
    list.split(", ").map(str::to_string).collect()
}

#[test]
fn every_table_has_the_keys_that_are_read() {
    let scenario = &SCHEMA["properties"]["scenario"]["items"];
    assert_eq!(keys(&SCHEMA), keys_read("zzzzzz = 1"));
    assert_eq!(keys(scenario), keys_read("[[scenario]]\nzzzzzz = 1"));
    let step = keys_read("[[scenario]]\nsteps = [{ zzzzzz = 1 }]");
    assert_eq!(keys(&scenario["properties"]["steps"]["items"]), step);
    assert_eq!(keys(&SCHEMA["properties"]["steps"]["items"]), step);
    for table in [&*SCHEMA, scenario, &scenario["properties"]["steps"]["items"]] {
        assert_eq!(table["additionalProperties"], Value::Bool(false));
    }
}

#[test]
fn the_examples_of_the_schema_are_read() {
    let scenario = &SCHEMA["properties"]["scenario"]["items"];
    let steps = &scenario["properties"]["steps"]["items"];
    let mut count = 0;
    for (table, head) in [(&*SCHEMA, ""), (scenario, "[[scenario]]\n"), (steps, "[[scenario]]\nsteps = [{ ")]
    {
        for (key, node) in table["properties"].as_object().unwrap() {
            for example in node["examples"].as_array().into_iter().flatten() {
                let value = toml::Value::try_from(example).unwrap();
                let text = match head.ends_with("{ ") {
                    true => format!("{head}{key} = {value}, set = {{ X7 = 1 }}, always = {{ Y7 = 0 }}, expect = {{ Y6 = 0 }} }}]")
                        .replace(&format!("{key} = {value}, set = {{ X7 = 1 }}"), &match key.as_str() {
                            "set" => format!("{key} = {value}"),
                            "every" => format!("{key} = {value}, times = 2, set = {{ X7 = 1 }}"),
                            "times" => format!("{key} = {value}, every = 50, set = {{ X7 = 1 }}"),
                            _ => format!("{key} = {value}, set = {{ X7 = 1 }}"),
                        }),
                    false => format!("{head}{key} = {value}\n"),
                };
                // What stands there besides must not be said twice.
                let text = match key.as_str() {
                    "always" => text.replace(", always = { Y7 = 0 }", ""),
                    "expect" => text.replace(", expect = { Y6 = 0 }", ""),
                    _ => text,
                };
                let told: Vec<String> =
                    Suite::read(&text).1.iter().map(|flaw| flaw.message.render(Language::English)).collect();
                // One key alone is not a whole file.
                let is_about_key = |told: &&String| {
                    !told.contains("there is no scenario here") && !told.contains("expects nothing, so it")
                };
                let wrong = told.iter().find(is_about_key);
                assert!(wrong.is_none(), "{text}: {told:?}");
                count += 1;
            }
        }
    }
    assert!(count >= 20, "{count}");
}

#[test]
fn keys_are_proposed_and_explained() {
    let folder = crate::binary::folder(&[("motor.il", "LD X0\nOUT Y0\nEND\n")]);
    let root = folder.path().canonicalize().unwrap();
    let uri = format!("file://{}", root.join("motor.test.toml").display());
    let mut client = Client::start_with(
        json!({"textDocument": {"hover": {"contentFormat": ["markdown"]}}}),
        json!({"language": "en"}),
    );
    client.open(&uri, "toml", "\n[[scenario]]\nname = \"a\"\n\nsteps = [\n  { at = 50,  },\n]\n");
    let at = |line: u32, character: u32| json!({"textDocument": {"uri": uri}, "position": {"line": line, "character": character}});
    let mut labels = |line, character| {
        let answer = client.request("textDocument/completion", at(line, character))["result"].clone();
        let items = answer.as_array().unwrap().iter();
        items.map(|item| item["label"].as_str().unwrap().to_string()).collect::<BTreeSet<_>>()
    };
    let root = labels(0, 0);
    assert!(root.contains("program") && root.contains("[[scenario]]") && root.contains("steps"), "{root:?}");
    let scenario = labels(3, 0);
    assert!(
        scenario.contains("golden") && !scenario.contains("name") && !scenario.contains("program"),
        "{scenario:?}"
    );
    let step = labels(5, 13);
    assert!(step.contains("expect") && step.contains("pulse") && !step.contains("golden"), "{step:?}");
    assert!(!step.contains("at"), "it is there already: {step:?}");
    let hover = client.request("textDocument/hover", at(5, 5))["result"].clone();
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(
        text.contains("The time of the step") && text.contains("3 scans") || text.contains("100ms"),
        "{text}"
    );
}
