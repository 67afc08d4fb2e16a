# Sourced by tools/run and tools/test: installs the Debian packages that are missing.
# Names are those of Debian 12 and 13 and Ubuntu 24.04.

carom_packages=(
    cmake g++ ninja-build
    libeigen3-dev libbox2d-dev libtomlplusplus-dev libfmt-dev nlohmann-json3-dev libcli11-dev
    libgl-dev libegl1 libegl-mesa0 libgl1-mesa-dri libpng-dev libcairo2-dev
    libgtest-dev libbenchmark-dev
    pkg-config python3 python3-numpy
)
# What continuous integration needs in addition: a second compiler with its sanitizers, the static checks, valgrind, what counts
# lines, what reads the completions and the man page, what runs the script of pages, and what makes films.
carom_check_packages=(clang clang-format clang-tidy glslang-tools valgrind llvm zsh groff-base nodejs ffmpeg)
# The browser that the tests open pages in. Ubuntu has it as a snap only: there these tests are left out.
carom_browser=chromium
# What the Python package is built and tested with (tools/python.sh); its tests are left out where they are missing.
carom_python_packages=(python3-dev python3-venv)
# What tools/docs makes the site with; it is left out where they are missing.
carom_docs_packages=(mkdocs mkdocs-material)
# Mesa dropped OSMesa with 25.1: later releases do not have it, and what it does there EGL does.
carom_osmesa=libosmesa6

carom_say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

# carom_help "$@": for -h or --help prints the comment that begins the script, and ends it.
carom_help() {
    case ${1:-} in
        -h | --help)
            sed -n '2,/^[^#]/s/^# \{0,1\}//p' "tools/${0##*/}"
            exit 0
            ;;
    esac
}

# carom_no_arguments "$@": ends a script that takes none, before it does anything.
carom_no_arguments() {
    [ $# -eq 0 ] && return
    echo "${0##*/}: takes no argument, but \"$1\" was given; see tools/${0##*/} --help" >&2
    exit 2
}

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

# Whether OSMesa is installed, or this release has it.
carom_has_osmesa() { carom_installed "$carom_osmesa" || [ -n "$(apt-cache show "$carom_osmesa" 2>/dev/null)" ]; }

# Whether root can be had; with a terminal, sudo may ask for a password.
carom_can_install() {
    carom_sudo_flags=
    [ "$(id -u)" -eq 0 ] && return 0
    command -v sudo >/dev/null || return 1
    { : </dev/tty; } 2>/dev/null && return 0
    carom_sudo_flags=-n
    sudo -n true 2>/dev/null
}

# carom_ensure NAME ...: installs those of the packages that are missing.
carom_ensure() {
    local missing
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        carom_say "this is no Debian or Ubuntu; install what these packages hold, then follow CONTRIBUTING.md:"
        carom_say "$*"
        exit 2
    fi
    missing=$(carom_missing "$@")
    # Package lists that do not know OSMesa say that there is none; no lists say nothing.
    if compgen -G '/var/lib/apt/lists/*Packages*' >/dev/null && ! carom_has_osmesa; then
        missing=${missing/$carom_osmesa /}
    fi
    [ -n "$missing" ] || return 0
    if ! carom_can_install; then
        carom_say "packages are missing, and installing them needs root or sudo. As root:"
        carom_say "apt-get install --no-install-recommends $missing"
        exit 2
    fi
    carom_say "installing: $missing"
    carom_apt update || carom_say "apt-get update failed; going on with the package lists that are there"
    carom_has_osmesa || missing=${missing/$carom_osmesa /}
    [ -n "$missing" ] || return 0
    # The list is split into words on purpose.
    # shellcheck disable=SC2086
    carom_apt install -y --no-install-recommends $missing && return 0
    carom_say "apt-get could not install: $missing"
    exit 2
}

# What building and testing need.
carom_ensure_packages() { carom_ensure "${carom_packages[@]}" "$carom_osmesa"; }

# What tools/fuzz, tools/sanitize and tools/lint need in addition.
carom_ensure_check_packages() {
    carom_ensure "${carom_check_packages[@]}"
    # The sanitizers' library is of clang's version: libclang-rt-14-dev in Debian 12.
    carom_ensure "libclang-rt-$(clang -dumpversion | cut -d. -f1)-dev"
    carom_installed "$carom_browser" || [ -z "$(apt-cache show "$carom_browser" 2>/dev/null)" ] || carom_ensure "$carom_browser"
}
