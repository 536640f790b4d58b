//! The kinds of semantic tokens that the server sends are those that the VS Code extension declares and gives colours.

use crate::lsp_client::Client;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Types and modifiers of the protocol, which editors know by themselves.
const STANDARD_TYPES: &[&str] = &[
    "namespace", "type", "class", "enum", "interface", "struct", "typeParameter", "parameter", "variable",
    "property", "enumMember", "event", "function", "method", "macro", "keyword", "modifier", "comment", "string",
    "number", "regexp", "operator", "decorator", "label",
];
const STANDARD_MODIFIERS: &[&str] = &[
    "declaration", "definition", "readonly", "static", "deprecated", "abstract", "async", "modification",
    "documentation", "defaultLibrary",
];

fn words(list: &Value) -> BTreeSet<String> {
    list.as_array().expect("a list").iter().map(|word| word.as_str().expect("a word").to_string()).collect()
}

/// Types and modifiers of the legend.
fn legend() -> (BTreeSet<String>, BTreeSet<String>) {
    let mut client = Client::spawn();
    let params = json!({"processId": null, "rootUri": null, "capabilities": {}});
    let answer = client.request("initialize", params);
    let legend = &answer["result"]["capabilities"]["semanticTokensProvider"]["legend"];
    (words(&legend["tokenTypes"]), words(&legend["tokenModifiers"]))
}

fn contributes() -> Value {
    let manifest: Value =
        serde_json::from_str(include_str!("../vscode-extension/package.json")).expect("package.json");
    manifest["contributes"].clone()
}

fn beyond(words: &BTreeSet<String>, standard: &[&str]) -> BTreeSet<String> {
    words.iter().filter(|word| !standard.contains(&word.as_str())).cloned().collect()
}

fn declared(list: &Value) -> BTreeSet<String> {
    let ids = list.as_array().into_iter().flatten().map(|entry| entry["id"].as_str().expect("an id").to_string());
    ids.collect()
}

/// The scopes of each language, with its name.
fn scopes() -> Vec<(String, Value)> {
    let contributes = contributes();
    let entries = contributes["semanticTokenScopes"].as_array().expect("scopes").iter();
    entries
        .map(|entry| (entry["language"].as_str().expect("a language").to_string(), entry["scopes"].clone()))
        .collect()
}

#[test]
fn what_the_protocol_does_not_know_is_declared_and_nothing_else() {
    let (types, modifiers) = legend();
    assert_eq!(beyond(&types, STANDARD_TYPES), declared(&contributes()["semanticTokenTypes"]));
    assert_eq!(beyond(&modifiers, STANDARD_MODIFIERS), declared(&contributes()["semanticTokenModifiers"]));
}

#[test]
fn every_kind_of_token_has_scopes_in_every_language_that_has_it() {
    let (types, modifiers) = legend();
    let own = beyond(&types, STANDARD_TYPES);
    for (language, scopes) in scopes() {
        // A selector is a type, with a modifier behind a dot where it has one.
        let keys: Vec<(String, Option<String>)> = scopes
            .as_object()
            .expect("an object")
            .keys()
            .map(|key| match key.split_once('.') {
                Some((kind, modifier)) => (kind.to_string(), Some(modifier.to_string())),
                None => (key.clone(), None),
            })
            .collect();
        let kinds: BTreeSet<String> = keys.iter().map(|(kind, _)| kind.clone()).collect();
        // An instruction list has no drawing.
        let drawn = language != "plc-il";
        let wanted: BTreeSet<String> =
            types.iter().filter(|kind| drawn || !own.contains(*kind)).cloned().collect();
        assert_eq!(kinds, wanted, "{language}");
        for modifier in keys.iter().filter_map(|(_, modifier)| modifier.as_ref()) {
            assert!(modifiers.contains(modifier), "{language}: {modifier}");
        }
    }
    let languages: BTreeSet<String> = scopes().into_iter().map(|(language, _)| language).collect();
    assert_eq!(languages, ["ladder", "markdown", "plc-il"].map(str::to_string).into());
}

#[test]
fn every_scope_is_one_of_the_grammars() {
    let grammars = [
        include_str!("../syntaxes/rungwise-il.tmLanguage.json"),
        include_str!("../syntaxes/rungwise-ladder.tmLanguage.json"),
    ]
    .concat();
    for (language, scopes) in scopes() {
        for (kind, names) in scopes.as_object().expect("an object") {
            for name in words(names) {
                assert!(grammars.contains(&format!("\"{name}\"")), "{language}, {kind}: {name}");
            }
        }
    }
}
