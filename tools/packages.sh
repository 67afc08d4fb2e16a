# Sourced by tools/run and tools/test: installs the Debian packages that are missing.
# Names are those of Debian 12 and 13 and Ubuntu 24.04.

carom_packages=(
    cmake g++ ninja-build
    libeigen3-dev libbox2d-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev libcli11-dev
    libosmesa6-dev libosmesa6 libgl-dev libpng-dev
    libgtest-dev libbenchmark-dev
)
carom_say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

carom_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

carom_missing() {
    local package
    for package in "$@"; do
        carom_installed "$package" || printf '%s ' "$package"
    done
}

# Runs apt-get as root: directly, or by sudo. Fails where there is neither.
carom_apt() {
    if [ "$(id -u)" -eq 0 ]; then
        env DEBIAN_FRONTEND=noninteractive apt-get "$@" </dev/null >&2
    else
        sudo ${carom_sudo_flags} env DEBIAN_FRONTEND=noninteractive apt-get "$@" </dev/null >&2
    fi
}

# Whether root can be had; with a terminal, sudo may ask for a password.
carom_can_install() {
    carom_sudo_flags=
    [ "$(id -u)" -eq 0 ] && return 0
    command -v sudo >/dev/null || return 1
    { : </dev/tty; } 2>/dev/null && return 0
    carom_sudo_flags=-n
    sudo -n true 2>/dev/null
}

carom_ensure_packages() {
    local missing
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        carom_say "this is no Debian or Ubuntu; install what these packages hold, then follow CONTRIBUTING.md:"
        carom_say "${carom_packages[*]}"
        exit 2
    fi
    missing=$(carom_missing "${carom_packages[@]}")
    [ -n "$missing" ] || return 0
    if ! carom_can_install; then
        carom_say "packages are missing, and installing them needs root or sudo. As root:"
        carom_say "apt-get install --no-install-recommends $missing"
        exit 2
    fi
    carom_say "installing: $missing"
    carom_apt update || carom_say "apt-get update failed; going on with the package lists that are there"
    # The list is split into words on purpose.
    # shellcheck disable=SC2086
    carom_apt install -y --no-install-recommends $missing && return 0
    carom_say "apt-get could not install: $missing"
    # Mesa dropped OSMesa with 25.1; the releases named above have it.
    [ -n "$(apt-cache show libosmesa6-dev 2>/dev/null)" ] || carom_say "this release has no libosmesa6-dev"
    exit 2
}
