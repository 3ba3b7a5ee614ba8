#!/usr/bin/env bash
# `make test` where other people run it: a row for each surrounding, in a clone of HEAD, and a table of all rows.
#
# Usage: scripts/everywhere.sh [ROW...]     rows: plain busy locale home alone user compiler oldest newest
# PYTEST_ADDOPTS restricts the tests, PYTHON names another Python. A row that this machine cannot have is skipped,
# with the reason. Exit code 1 if a row fails.
set -uo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
root=$(mktemp -d "${TMPDIR:-/tmp}/everywhere-XXXXXX")
here=$PWD
table=$root/table.txt
siconos=/usr/lib/python3/dist-packages/siconos
failed=0
trap 'rm -rf "$root"' EXIT

clone() {  # a clone with ../shared beside it, if there is one
  mkdir -p "$root/$1"
  git clone --quiet "$here" "$root/$1/wedgesweep"
  if [ "${2:-}" != alone ] && [ -d ../shared ]; then ln -s "$(realpath ../shared)" "$root/$1/shared"; fi
  cd "$root/$1/wedgesweep" || exit 2
}

pins() {  # "==" the oldest versions that pyproject.toml allows
  "$python" - <<'END'
import re, tomllib
for each in tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"]:
    name, version = re.match(r"([\w-]+)>=([\d.]+)", each).groups()
    print(f"{name}=={version}.*")
END
}

row() {  # row NAME COMMAND...: run it, and add a line to the table
  local name=$1 began=$SECONDS last status
  shift
  "$@" >"$root/$name.log" 2>&1
  status=$?
  last=$(grep -E '(passed|failed).* in ' "$root/$name.log" | tail -n 1)
  printf '%-9s %-6s %4d s  %s\n' "$name" "$([ $status = 0 ] && echo passes || echo FAILS)" \
    $((SECONDS - began)) "$last" | tee -a "$table"
  if [ $status != 0 ]; then failed=1; tail -n 40 "$root/$name.log"; fi
}

skip() { printf '%-9s skipped: %s\n' "$1" "$2" | tee -a "$table"; }

run_busy() {
  local busy=() status
  for _ in 1 2 3 4; do while :; do :; done & busy+=($!); done
  make test; status=$?
  kill "${busy[@]}"
  return $status
}

run_alone() {  # without ../shared, and without a browser and siconos if this machine has them
  if command -v chromium google-chrome >/dev/null || [ -d "$siconos" ]; then
    unshare --mount bash -c '
      for program in $(command -v chromium google-chrome); do mount --bind /dev/null "$program"; done
      if [ -d "$1" ]; then mount -t tmpfs none "$1"; fi
      make test PYTHON="$2"' - "$siconos" "$python"
  else
    make PYTHON="$python" test
  fi
}

run_as_nobody() {  # a Python that others can read is needed, and a folder that they own
  chmod 755 "$root" "$root/user"
  chown -R nobody: "$root/user"
  setpriv --reuid nobody --regid nogroup --clear-groups env -i PATH=/usr/bin:/bin HOME="$root/user" \
    PIP_INDEX_URL="${PIP_INDEX_URL:-}" make PYTHON=/usr/bin/python3 test
}

run_versions() {  # oldest or newest
  make --silent PYTHON="$python" install || return
  if [ "$1" = oldest ]; then pins | xargs .venv/bin/pip install --quiet || return
  else .venv/bin/pip install --quiet --upgrade --upgrade-strategy eager --editable '.[test]' || return; fi
  .venv/bin/pip list 2>/dev/null | grep -E '^(numba|numpy|scipy|xarray) '
  # Old libraries warn of each other.
  if [ "$1" = oldest ]; then PYTEST_ADDOPTS="${PYTEST_ADDOPTS:-} -W default" make test; else make test; fi
}

# All rows in one clone use one cache of compiled code; versions have clones of their own.
clone shared
common=$PWD
make --silent PYTHON="$python" install >"$root/install.log" 2>&1 || { cat "$root/install.log"; exit 1; }
for name in ${*:-plain busy locale home alone user compiler oldest newest}; do
  cd "$common" || exit 2
  case $name in
    plain) row plain make test ;;
    busy) row busy run_busy ;;
    locale) row locale env -u LANG LC_ALL=C TZ=Pacific/Kiritimati make test ;;
    home) row home env HOME=/proc/none XDG_CACHE_HOME=/proc/none make test ;;
    alone) clone alone alone; row alone run_alone ;;
    user)
      if [ "$(id -u)" != 0 ]; then skip user "all rows are, as root has not called this"; continue; fi
      /usr/bin/python3 -m venv "$root/venv" >/dev/null 2>&1 || { skip user "no venv for /usr/bin/python3"; continue; }
      clone user
      row user run_as_nobody ;;
    compiler) row compiler env WEDGESWEEP_COMPILER=plain make test ;;
    oldest | newest) clone "$name"; row "$name" run_versions "$name" ;;
    *) echo "no row $name" >&2; exit 2 ;;
  esac
done
echo
cat "$table"
exit $failed
