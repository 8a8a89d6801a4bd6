# shellcheck shell=bash
# Sourced by quickstart and check, which stand in the root: the packages and the build, quietly.

# install_packages SET...: installs by apt what is missing of the lists in config/packages/, as root
# or with sudo; where neither works, one line says what to type. Nothing missing: no network.
install_packages() {
    local set package wanted=() missing=() as_root=()
    for set in "$@"; do
        mapfile -t -O "${#wanted[@]}" wanted < <(grep -vE '^(#|$)' "config/packages/$set.txt")
    done
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        echo "This is not a Debian: its like of these packages is taken to be there: ${wanted[*]}" >&2
        return 0
    fi
    for package in "${wanted[@]}"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null || ! { sudo -n true 2>/dev/null ||
            { [ -t 0 ] && sudo -v; }; }; then
            echo "Packages are missing; please run as root: apt-get update &&" \
                "apt-get install --no-install-recommends ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "Installing ${#missing[@]} packages: ${missing[*]}"
    as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=120)
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" update &&
        "${as_root[@]}" -y --no-install-recommends install "${missing[@]}"; } </dev/null >"$log" 2>&1; then
        tail -n 15 "$log" >&2
        rm -f "$log"
        echo "apt could not install them; please run as root: apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
        return 1
    fi
    rm -f "$log"
}

# configure PRESET [OPTION...]: into build/PRESET. Without ccache: it would hash the precompiled headers
# for each file, which costs a third of a compilation.
configure() {
    local preset=$1
    shift
    mkdir -p "build/$preset"
    if ! cmake --preset "$preset" "$@" >"build/$preset/configure.log" 2>&1; then
        tail -n 30 "build/$preset/configure.log"
        echo "cmake failed; the whole log is in build/$preset/configure.log" >&2
        return 1
    fi
}

# build DIR TARGET...: one line of progress on a terminal; the errors and the log's tail on failure.
build() {
    local dir=$1 begin=$SECONDS log=$1/build.log
    shift
    echo "Building $* in $dir ..."
    cmake --build "$dir" --target "$@" 2>&1 | tee "$log" | progress_line
    if [ "${PIPESTATUS[0]}" != 0 ]; then
        grep -nE '(error|undefined reference).*: |^FAILED' "$log" | head -n 20
        tail -n 30 "$log"
        echo "The build failed; the whole log is in $log" >&2
        return 1
    fi
    echo "Built in $((SECONDS - begin)) s"
}

# progress_line: on a terminal the newest "[12/80] ..." of ninja, in place; else nothing.
progress_line() {
    if [ -t 1 ]; then
        local line
        while IFS= read -r line; do
            case $line in '['*) printf '\r\033[K%.78s' "$line" ;; esac
        done
        printf '\r\033[K'
    else
        cat >/dev/null
    fi
}
