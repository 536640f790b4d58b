# Rungwise. `make help` lists what can be made.
# Everything that a target needs beyond Rust, Node and make it installs by itself.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
RUNGWISE := target/release/rungwise

.PHONY: help demo test test-rust test-clients test-editors lint bench fuzz soak vscode neovim clean linker

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: $(RUNGWISE) ## build, check, translate, run and test the example project, and show what mistakes look like
	@echo
	@echo "== rungwise check examples/motor"
	@$(RUNGWISE) check examples/motor
	@echo
	@echo "== rungwise check examples/mistakes/short-circuit.lad (a mistake, on purpose)"
	@$(RUNGWISE) check examples/mistakes/short-circuit.lad || [ $$? -eq 1 ]
	@echo "== rungwise check examples/mistakes/mixed-connection.lad (a mistake, on purpose)"
	@$(RUNGWISE) check examples/mistakes/mixed-connection.lad || [ $$? -eq 1 ]
	@echo "== rungwise fmt --stdout --style unicode examples/motor/motor.lad"
	@$(RUNGWISE) fmt --stdout --style unicode examples/motor/motor.lad
	@echo "== rungwise translate examples/motor/motor.lad --to fx --prove"
	@$(RUNGWISE) translate examples/motor/motor.lad --to fx --prove
	@echo "== rungwise run examples/motor/motor.lad: X0 is pressed for a moment, then the stop X2"
	@$(RUNGWISE) run examples/motor/motor.lad --set X2=1 --set X3=1 --set X0=1@100ms --set X0=0@150ms --set X2=0@500ms \
	  --watch X0,X2,Y0,Y1 --why Y0@300ms
	@echo "== rungwise test examples/motor"
	@$(RUNGWISE) test examples/motor
	@echo "== rungwise plc: a virtual PLC gets the program, is started, and its inputs are switched"
	@folder=$$(mktemp -d); cp -r examples/motor $$folder; $(RUNGWISE) plc --listen 127.0.0.1:0 > $$folder/said & plc=$$!; \
	  trap "kill $$plc; rm -rf $$folder" EXIT; \
	  until grep -q tcp $$folder/said; do sleep 0.1; done; cat $$folder/said; port=$$(grep -o 'tcp://[^ ]*' $$folder/said); \
	  $(RUNGWISE) download $$folder/motor --port $$port --yes --start; \
	  $(RUNGWISE) force X2=on X3=on X0=on --port $$port; sleep 0.1; $(RUNGWISE) force X0=off --port $$port; sleep 0.1; \
	  $(RUNGWISE) monitor X0 X2 X3 Y0 Y1 --count 1 --port $$port; $(RUNGWISE) verify $$folder/motor --port $$port
	@echo "Next: make vscode, then open the folder examples/ in VS Code."

test: lint test-rust test-clients test-editors ## everything that has to pass before a change lands

lint: linker ## format and lint
	cargo fmt --check
	cargo clippy --all-targets -- -D warnings

# What is random in a test is the same each time, so that a change is judged by what it changes; `make soak` takes others.
test-rust: linker ## tests of the server
	PROPTEST_RNG_SEED=$${PROPTEST_RNG_SEED:-61131} cargo test
	cargo build --release

soak: linker ## the random tests with other programs than in `make test`, SOAK_ROUNDS=10 times
	for round in $$(seq $${SOAK_ROUNDS:-10}); do seed=$$RANDOM; echo "PROPTEST_RNG_SEED=$$seed"; \
	  PROPTEST_RNG_SEED=$$seed cargo test --test all -- \
	    $$(grep -l 'proptest!' -r tests --include='*.rs' | sed 's/.*\///; s/\.rs$$/::/'); \
	done

test-clients: $(RUNGWISE) ## the virtual PLC under a client that was not written with it
	cd tests/clients && npm ci --no-audit --no-fund && RUNGWISE_SERVER=$(abspath $(RUNGWISE)) node --test fxplc.mjs

test-editors: $(RUNGWISE) ## extension, grammars, real Neovim, real VS Code
	RUNGWISE_SERVER=$(abspath $(RUNGWISE)) tests/editors/run.sh all

bench: linker ## measure; the figures of BENCHMARKS.md
	cargo bench --bench bench

# The flags of the sanitizers are not stable, but without sanitizers the stable compiler has all that is needed.
fuzz: linker ## look for bytes that break a promise, FUZZ_SECONDS=60 for each target
	command -v cargo-fuzz >/dev/null || cargo install cargo-fuzz
	cd fuzz && for target in $$(sed -n 's/^name = "\([a-z]*\)"$$/\1/p' Cargo.toml); do \
	  RUSTC_BOOTSTRAP=1 cargo fuzz run --sanitizer none $$target -- \
	    -max_total_time=$${FUZZ_SECONDS:-60} -timeout=10 -max_len=4096; \
	done

vscode: $(RUNGWISE) ## build the VS Code extension with the server inside and install it
	cd vscode-extension && npm ci --no-audit --no-fund && npm run package
	@if command -v code >/dev/null; then code --install-extension vscode-extension/rungwise.vsix --force; \
	else echo "VS Code's command 'code' is not on the PATH; install vscode-extension/rungwise.vsix from the Extensions view."; fi

neovim: $(RUNGWISE) ## say how to use the Neovim plugin from this folder
	@echo "Add to your init.lua:"
	@echo "  vim.opt.runtimepath:prepend('$(abspath neovim)')"
	@echo "  vim.env.PATH = '$(abspath target/release):' .. vim.env.PATH"
	@echo "  vim.lsp.enable('rungwise')"

clean: ## remove what was built; installed editors stay in .cache
	cargo clean
	rm -rf vscode-extension/node_modules vscode-extension/dist vscode-extension/bin

$(RUNGWISE): linker FORCE
	cargo build --release

.PHONY: FORCE
FORCE:

# Rust links with the system's C compiler, which a fresh Debian has not.
linker:
	@command -v cc >/dev/null || { \
	  echo "installing build-essential for the linker"; \
	  sudo=$$([ "$$(id -u)" = 0 ] || echo sudo); \
	  $$sudo apt-get update -qq && $$sudo apt-get install -y -qq build-essential; }
