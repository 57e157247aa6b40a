#!/usr/bin/env bash
# Fails when a tracked C++ file is not as clang-format leaves it; exits with 77 where that cannot be told.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
  echo "skipped: $1"
  exit 77
}
wanted=14 # Debian 12's; others lay some lines out differently
command -v clang-format >/dev/null || skip "no clang-format"
clang-format --version | grep -q "version $wanted\." || skip "clang-format is not version $wanted"
git rev-parse --git-dir >/dev/null 2>&1 || skip "not a git checkout"
# The headers that GLSL shares are laid out as tables.
git ls-files -z '*.h' '*.cpp' ':!shaders' | xargs -0 clang-format --dry-run -Werror
