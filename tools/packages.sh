# Sourced by tools/run and tools/test: installs missing Debian packages.
# The names are those of Debian 12 and 13 and Ubuntu 24.04.

carom_packages=(
    cmake g++ ninja-build
    libeigen3-dev libbox2d-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev libcli11-dev
    libgl-dev libegl1 libegl-mesa0 libgl1-mesa-dri libpng-dev libcairo2-dev
    libgtest-dev libbenchmark-dev
    pkg-config python3 python3-numpy
)
# Continuous integration also needs a second compiler with its sanitizers, the static checks, valgrind, line
# counts, readers for completions and man pages, node for the scripts of pages, and ffmpeg for films.
carom_check_packages=(clang clang-format clang-tidy glslang-tools valgrind llvm zsh groff-base nodejs ffmpeg)
# The browsers for the tests of pages. Ubuntu has them only as snaps, so these tests are skipped there.
carom_browsers=(chromium firefox-esr)
# For building and testing the Python package (tools/python.sh); without them its tests are skipped.
carom_python_packages=(python3-dev python3-venv)
# For the site of tools/docs, which is skipped without them.
carom_docs_packages=(mkdocs mkdocs-material)
# Mesa dropped OSMesa in 25.1; in later releases EGL does its work.
carom_osmesa=libosmesa6

carom_say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

# carom_help "$@": for -h or --help, prints the comment at the top of the script and exits.
carom_help() {
    case ${1:-} in
        -h | --help)
            sed -n '2,/^[^#]/s/^# \{0,1\}//p' "tools/${0##*/}"
            exit 0
            ;;
    esac
}

# carom_no_arguments "$@": for scripts without arguments; exits with a message if there is one.
carom_no_arguments() {
    [ $# -eq 0 ] && return
    echo "${0##*/}: takes no argument, but \"$1\" was given; see tools/${0##*/} --help" >&2
    exit 2
}

carom_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

carom_available() { [ -n "$(apt-cache show "$1" 2>/dev/null)" ]; }

carom_missing() {
    local package
    for package in "$@"; do
        carom_installed "$package" || printf '%s ' "$package"
    done
}

# Installs the packages of tools/package.json in build/npm, once for each version of that file.
carom_npm() {
    cmp -s tools/package.json build/npm/installed.json && return
    mkdir -p build/npm
    cp tools/package.json build/npm
    npm install --silent --no-audit --no-fund --no-package-lock --prefix build/npm >&2 || return
    cp tools/package.json build/npm/installed.json
}

# Runs apt-get as root, directly or with sudo. Fails if neither is possible.
carom_apt() {
    if [ "$(id -u)" -eq 0 ]; then
        env DEBIAN_FRONTEND=noninteractive apt-get "$@" </dev/null >&2
    else
        sudo ${carom_sudo_flags} env DEBIAN_FRONTEND=noninteractive apt-get "$@" </dev/null >&2
    fi
}

# Whether OSMesa is installed or available in this release.
carom_has_osmesa() { carom_installed "$carom_osmesa" || carom_available "$carom_osmesa"; }

# Whether root is available; on a terminal, sudo may ask for a password.
carom_can_install() {
    carom_sudo_flags=
    [ "$(id -u)" -eq 0 ] && return 0
    command -v sudo >/dev/null || return 1
    { : </dev/tty; } 2>/dev/null && return 0
    carom_sudo_flags=-n
    sudo -n true 2>/dev/null
}

# carom_ensure NAME ...: installs the packages that are missing.
carom_ensure() {
    local missing
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        carom_say "this is not Debian or Ubuntu; install the contents of these packages, see CONTRIBUTING.md:"
        carom_say "$*"
        exit 2
    fi
    missing=$(carom_missing "$@")
    # Only existing package lists can tell that OSMesa is not available.
    if compgen -G '/var/lib/apt/lists/*Packages*' >/dev/null && ! carom_has_osmesa; then
        missing=${missing/$carom_osmesa /}
    fi
    [ -n "$missing" ] || return 0
    if ! carom_can_install; then
        carom_say "packages are missing, and installing them needs root or sudo; as root, run"
        carom_say "apt-get install --no-install-recommends $missing"
        exit 2
    fi
    carom_say "installing: $missing"
    carom_apt update || carom_say "apt-get update failed; continuing with the existing package lists"
    carom_has_osmesa || missing=${missing/$carom_osmesa /}
    [ -n "$missing" ] || return 0
    # The list is split into words on purpose.
    # shellcheck disable=SC2086
    carom_apt install -y --no-install-recommends $missing && return 0
    carom_say "apt-get could not install $missing; install them by hand"
    exit 2
}

# The packages for building and testing.
carom_ensure_packages() { carom_ensure "${carom_packages[@]}" "$carom_osmesa"; }

# The packages that tools/fuzz, tools/sanitize and tools/lint need in addition.
carom_ensure_check_packages() {
    carom_ensure "${carom_check_packages[@]}"
    # The sanitizers' library has clang's version: libclang-rt-14-dev in Debian 12.
    carom_ensure "libclang-rt-$(clang -dumpversion | cut -d. -f1)-dev"
    local browser
    for browser in "${carom_browsers[@]}"; do
        if ! carom_installed "$browser" && carom_available "$browser"; then carom_ensure "$browser"; fi
    done
}
