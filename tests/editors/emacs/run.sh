#!/bin/sh
# The smoke test in a real Emacs with eglot: what a user without any plugin gets.
#
# Usage: emacs/run.sh SERVER
set -u

TESTS=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
home=$(mktemp -d "${TMPDIR:-/tmp}/rungwise-emacs-XXXXXX")
trap 'rm -rf "$home"' EXIT
cp -r "$TESTS/fixtures" "$home/work"
cd "$home/work" || exit 1
HOME=$home RUNGWISE_SERVER=$1 timeout --kill-after=5 120 \
    emacs --batch --no-init-file --no-site-file --load "$TESTS/emacs/tests.el" --funcall rungwise-tests-run </dev/null
