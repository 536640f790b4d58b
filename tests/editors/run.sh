#!/bin/sh
# Runs the tests of the editors and prints, as its last line, how many passed and failed.
#
# Usage: tests/editors/run.sh [vscode|neovim|emacs|extension-unit|grammar|all]
# The server is $RUNGWISE_SERVER, else the newer of target/release/rungwise and target/debug/rungwise.
# What is needed is installed once into .cache/editors (or $RUNGWISE_EDITOR_CACHE). Screenshots and logs: artefacts/.
set -u

TESTS=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
ROOT=$(CDPATH= cd -- "$TESTS/../.." && pwd)
EXTENSION=$ROOT/vscode-extension
CACHE=${RUNGWISE_EDITOR_CACHE:-$ROOT/.cache/editors}
ARTEFACTS=$TESTS/artefacts
passed=0
failed=0

# One suite: runs a command with a bound on its time and adds up its lines "N passed, N failed". A suite that fails
# without saying so, or that runs nothing, counts as one failure: nothing is skipped in silence.
suite() {
    name=$1 seconds=$2
    shift 2
    log=$ARTEFACTS/$name.log
    echo "== $name"
    { timeout --kill-after=15 "$seconds" "$@" 2>&1; echo "exit code $?"; } | tee "$log"
    code=$(sed -n 's/^exit code //p' "$log" | tail -1)
    ok=$(sed -n 's/^\([0-9][0-9]*\) passed, [0-9][0-9]* failed$/\1/p' "$log" | awk '{ n += $1 } END { print n + 0 }')
    bad=$(sed -n 's/^[0-9][0-9]* passed, \([0-9][0-9]*\) failed$/\1/p' "$log" | awk '{ n += $1 } END { print n + 0 }')
    if [ "$bad" -eq 0 ] && { [ "$code" -ne 0 ] || [ "$ok" -eq 0 ]; }; then
        echo "FAILED  $name ended with exit code $code after $ok checks"
        bad=1
    fi
    passed=$((passed + ok))
    failed=$((failed + bad))
}

find_server() {
    server=${RUNGWISE_SERVER:-}
    if [ -z "$server" ]; then
        # The names are fixed, so listing them by time is safe.
        # shellcheck disable=SC2012
        server=$(ls -t "$ROOT/target/release/rungwise" "$ROOT/target/debug/rungwise" 2>/dev/null | head -1)
    fi
    if [ -z "$server" ] || [ ! -x "$server" ]; then
        echo "no server: build it with \"cargo build\", or set RUNGWISE_SERVER" >&2
        return 1
    fi
    # The tests change folders, so the path has to be absolute.
    server=$(CDPATH= cd -- "$(dirname -- "$server")" && pwd)/$(basename -- "$server")
}

# Installs the packages of a folder when its lock file is newer than what is installed.
node_packages() {
    if [ ! -f "$1/node_modules/.package-lock.json" ] || [ "$1/package-lock.json" -nt "$1/node_modules/.package-lock.json" ]; then
        (cd "$1" && npm ci --no-audit --no-fund && touch node_modules/.package-lock.json)
    fi
}

extension_unit() {
    node_packages "$EXTENSION" && cd "$EXTENSION" && npm test --silent || return 1
}

# The test runner of Node says "pass 31" and "fail 0", each on a line of its own.
counted_by_node() {
    extension_unit 2>&1 | tee "$ARTEFACTS/extension-unit.out"
    ok=$(sed -n 's/.* pass \([0-9][0-9]*\)$/\1/p' "$ARTEFACTS/extension-unit.out" | tail -1)
    bad=$(sed -n 's/.* fail \([0-9][0-9]*\)$/\1/p' "$ARTEFACTS/extension-unit.out" | tail -1)
    echo "${ok:-0} passed, ${bad:-1} failed"
    [ "${bad:-1}" -eq 0 ]
}

# One check for each file of assertions; the tool prints a tick or a cross before its name.
grammar() {
    node_packages "$TESTS" || return 1
    cd "$TESTS" || return 1
    npx --no-install vscode-tmgrammar-test -g "$ROOT/syntaxes/rungwise-il.tmLanguage.json" \
        -g "$ROOT/syntaxes/rungwise-ladder.tmLanguage.json" -g "$ROOT/syntaxes/rungwise-forms.tmLanguage.json" "$ROOT/syntaxes/tests/*.test.*" 2>&1 | tee "$ARTEFACTS/grammar.out"
    ok=$(grep -c '^✓ ' "$ARTEFACTS/grammar.out")
    bad=$(grep -c '^✖ ' "$ARTEFACTS/grammar.out")
    files=$(find "$ROOT/syntaxes/tests" -name '*.test.*' | wc -l)
    if [ $((ok + bad)) -ne "$files" ]; then
        echo "FAILED  $files files of assertions, $((ok + bad)) results"
        bad=$((bad + 1))
    fi
    echo "$ok passed, $bad failed"
    [ "$bad" -eq 0 ]
}

vscode() {
    "$TESTS/install-code-server.sh" && node_packages "$EXTENSION" && node_packages "$TESTS" && find_server || return 1
    rm -f "$ARTEFACTS"/*.png
    exec node "$TESTS/vscode/run.mjs" "$CACHE" "$ARTEFACTS" "$server"
}

neovim() {
    "$TESTS/install-neovim.sh" && find_server || return 1
    exec "$TESTS/neovim/run.sh" "$CACHE" "$server"
}

emacs_eglot() {
    "$TESTS/install-emacs.sh" && find_server || return 1
    exec "$TESTS/emacs/run.sh" "$server"
}

mkdir -p "$ARTEFACTS" "$CACHE"
case ${1:-all} in
    # A suite runs as a process of its own, so that a time limit can end all of it.
    --inside) "$2"; exit $? ;;
    extension-unit) chosen=extension-unit ;;
    grammar | vscode | neovim | emacs) chosen=$1 ;;
    all) chosen='extension-unit grammar emacs neovim vscode' ;;
    *) echo "usage: run.sh [vscode|neovim|emacs|extension-unit|grammar|all]" >&2; exit 2 ;;
esac
for name in $chosen; do
    case $name in
        extension-unit) suite extension-unit 300 "$0" --inside counted_by_node ;;
        grammar) suite grammar 180 "$0" --inside grammar ;;
        emacs) suite emacs 300 "$0" --inside emacs_eglot ;;
        neovim) suite neovim 900 "$0" --inside neovim ;;
        vscode) suite vscode 1800 "$0" --inside vscode ;;
    esac
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
