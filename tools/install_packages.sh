#!/usr/bin/env bash
# Installs the Debian packages of the given groups of packages.txt that are missing.
#   bash tools/install_packages.sh build test
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

(($# > 0)) || { echo "usage: install_packages.sh GROUP... (build, test, lint, fuzz)" >&2; exit 2; }

# Prints the packages of one group: the lines below "# GROUP: ..." up to the next comment.
packages_of() {
  awk -v group="# $1:" '/^#/ { on = index($0, group) == 1 } !/^#/ && NF && on' "$here/packages.txt"
}

wanted=()
for group in "$@"; do
  mapfile -t -O "${#wanted[@]}" wanted < <(packages_of "$group")
  [[ -n $(packages_of "$group") ]] || { echo "no group '$group' in packages.txt" >&2; exit 2; }
done

missing=()
for package in "${wanted[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $state == installed* ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

echo "Installing ${missing[*]}"
as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || { echo "not root and no sudo: install them yourself" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  "${missing[@]}" >/dev/null
