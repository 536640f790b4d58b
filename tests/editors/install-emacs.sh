#!/bin/sh
# Installs Emacs and eglot for the editor tests: the packages emacs-nox and elpa-eglot of Debian or Ubuntu.
#
# Usage: tests/editors/install-emacs.sh
# apt-get is called only for packages that are missing, with sudo when the caller is not root. Emacs 29 and later bring
# eglot themselves.
set -eu

has_eglot() {
    command -v emacs >/dev/null &&
        emacs --batch --eval "(progn (package-initialize) (kill-emacs (if (require 'eglot nil t) 0 1)))" 2>/dev/null
}

if has_eglot; then
    echo "Emacs with eglot is installed"
    exit 0
fi
sudo=
[ "$(id -u)" = 0 ] || sudo=sudo
$sudo apt-get update -qq
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends emacs-nox
has_eglot || $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends elpa-eglot
has_eglot || { echo "there is no eglot for this Emacs" >&2; exit 1; }
