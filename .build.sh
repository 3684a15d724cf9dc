# Sourced by ./run and ./test: packages, configuration and build. All messages go to standard error.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release
log=$root/build/setup.log

say() { printf '%s\n' "$*" >&2; }
die() { say "$*"; exit 1; }

# quietly WHAT COMMAND...: one line for the phase, with ninja's count on a terminal; the output is shown only when the
# command fails.
quietly() {
  local what=$1 status=0 line
  shift
  mkdir -p "$build"
  if [[ -t 2 ]]; then
    printf '%s ...' "$what" >&2
    "$@" 2>&1 </dev/null | tee "$log" | while IFS= read -r line; do
      [[ $line =~ ^\[([0-9]+/[0-9]+)\] ]] && printf '\r%s %s ...' "$what" "${BASH_REMATCH[1]}" >&2
    done || status=${PIPESTATUS[0]}
    printf '\n' >&2
  else
    say "$what ..."
    "$@" >"$log" 2>&1 </dev/null || status=$?
  fi
  ((status == 0)) || {
    cat "$log" >&2
    die "failed: $* (status $status; the log is $log)"
  }
}

missing_packages() {
  local wanted
  mapfile -t wanted < <(sed -e 's/#.*//' -e '/^ *$/d' "$root/.debian-packages")
  # Installed packages print their names; the rest of the list is missing.
  comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^installed //p' | sort -u)
}

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    command -v cmake >/dev/null && command -v ninja >/dev/null && return 0
    die "This is no Debian system: install what these packages hold, then run this again:" \
      "$(sed -e 's/#.*//' "$root/.debian-packages" | tr -s '\n' ' ')"
  fi
  local missing
  mapfile -t missing < <(missing_packages)
  ((${#missing[@]} > 0)) || return 0
  command -v apt-get >/dev/null || die "apt-get is not here. Install these packages, then run this again: ${missing[*]}"
  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "Neither root nor sudo. Let root do: apt-get install ${missing[*]}"
    as_root=(sudo)
    say "Installing needs root:"
    sudo -v || die "Not permitted to use sudo. Let root do: apt-get install ${missing[*]}"
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -q)
  # A slightly old package list can be sufficient; otherwise the installation fails.
  mkdir -p "$build"
  "${as_root[@]}" update >"$log" 2>&1 </dev/null || say "apt-get update failed; trying with the present package lists"
  quietly "Installing ${missing[*]}" "${as_root[@]}" install -y --no-install-recommends "${missing[@]}"
}

configure_and_build() {
  # Ninja itself configures again when a CMake file changes, but it does not know the presets.
  if [[ ! -f $build/build.ninja || $root/CMakePresets.json -nt $build/build.ninja ]]; then
    (cd "$root" && quietly "Configuring" cmake --preset release)
  fi
  (cd "$root" && quietly "Building" cmake --build --preset release "$@")
}

# prepare [CMAKE BUILD ARGUMENTS]: everything up to the built program. Two at once wait for each other.
prepare() {
  mkdir -p "$root/build"
  if command -v flock >/dev/null; then
    exec 9>"$root/build/.lock"
    flock -n 9 || { say "Waiting for another ./run or ./test to finish building ..."; flock 9; }
  fi
  install_packages
  configure_and_build "$@"
  exec 9>&-
}
