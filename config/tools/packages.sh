# Sourced by quickstart and check: install_packages SET... installs what is missing of the lists in
# config/packages/ by apt, as root or with sudo; says in one line what to do where neither works.
install_packages() {
    local set missing=()
    local wanted=()
    for set in "$@"; do
        mapfile -t -O "${#wanted[@]}" wanted < <(grep -vE '^(#|$)' "config/packages/$set.txt")
    done
    local package
    for package in "${wanted[@]}"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    local as_root=()
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
            echo "Missing packages: ${missing[*]}. Install them as root: apt-get install ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    if ! command -v apt-get >/dev/null; then
        echo "Missing packages: ${missing[*]}. This is not a Debian: install their like by hand." >&2
        return 1
    fi
    echo "Installing ${#missing[@]} packages: ${missing[*]}"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update </dev/null &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y \
            --no-install-recommends install "${missing[@]}" </dev/null >/dev/null
}

# launcher: the CMake options that use ccache where it is installed.
launcher() {
    if command -v ccache >/dev/null; then echo -DCMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
}

# build DIR TARGET...: builds quietly; shows the log's tail when it fails.
build() {
    local dir=$1
    shift
    local log=$dir/build.log begin=$SECONDS
    echo "Building $* in $dir ..."
    if ! cmake --build "$dir" --target "$@" >"$log" 2>&1; then
        grep -nE 'error|FAILED' "$log" | head -n 20
        tail -n 30 "$log"
        echo "The build failed; the whole log is in $log" >&2
        return 1
    fi
    echo "Built in $((SECONDS - begin)) s"
}
