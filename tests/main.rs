//! Every test of the package that needs no private item, one module for each subject.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test that fails says so by a panic"
)]

mod binary;
mod box_pins;
mod chinese;
mod cli;
mod cli_run;
mod cli_test;
mod cli_translate;
mod cli_usage;
mod command_line;
mod comments;
mod corpus;
mod dap;
mod dap_client;
mod document;
mod drawing_redrawn;
mod extremes;
mod fuzz;
mod grammar;
mod ide;
mod ide_boolean;
mod ide_devices;
mod ide_forms_iec;
mod ide_names;
mod ide_refactor;
mod ide_refactor_forms;
mod ide_refactor_iec;
mod ide_signature;
mod ide_structure;
mod ide_typing;
mod il_fx;
mod il_iec;
mod ladder_by_hand;
mod ladder_generate;
mod ladder_print;
mod ladder_read;
mod ldmicro;
mod logic_minimal;
mod lsp;
mod lsp_calls;
mod lsp_client;
mod lsp_edit;
mod lsp_panel;
mod lsp_project;
mod lsp_prove;
mod lsp_refactor;
mod lsp_robust;
mod lsp_simulation;
mod lsp_streaming;
mod lsp_test;
mod lsp_tokens;
mod lsp_translate;
mod lsp_within;
mod manifest_help;
mod manifest_schema;
mod markdown;
mod mistakes;
mod plain_instructions;
mod proof_declarations;
mod proof_memory;
mod proof_numbers;
mod proof_values;
mod proof_verdicts;
mod rules;
mod rules_across;
mod rules_boxes;
mod rules_drawing;
mod rules_exclusion;
mod rules_fx;
mod rules_iec;
mod rules_proof;
mod rules_sense;
mod rules_sense_fixes;
mod scenario_mutants;
mod scenario_schema;
mod simulate;
mod simulate_devices;
mod simulate_faults;
mod simulate_iec;
mod simulate_iec_blocks;
mod simulate_iec_programs;
mod simulate_recorder;
mod simulate_rungs;
mod simulate_session;
mod simulate_why;
mod simulate_words;
mod stack_machine;
mod target_fx;
mod target_fx_applied;
mod target_iec;
mod tidy;
mod token_scopes;
mod translate;
mod translate_iec;
mod translate_two_outputs;
mod translate_words;
mod unit_calls;
mod usage;
mod word_machines;
