# Sourced after tools/packages.sh: an environment in build/python-env for building and testing the Python
# package. It sees the system's packages.

# Packages from PyPI for the tests and for building the package (pyproject.toml names the latter, too). The
# type check needs numpy 2.4: the types of 2.2, in Debian 13, are less complete.
carom_python_needs=('nanobind>=2.9' 'pytest>=8' 'mypy>=1.11' 'numpy>=2.4' pyarrow dask distributed
    dask-jobqueue duckdb 'matplotlib>=3.9' pandas 'gymnasium>=1.1' 'pettingzoo>=1.25')

# carom_make_python_env: sets carom_python to the environment's interpreter, or fails with the reason in
# carom_no_python.
carom_make_python_env() {
    carom_python= carom_no_python=
    local missing env=build/python-env log=build/python-env.log
    mkdir -p build
    missing=$(carom_missing "${carom_python_packages[@]}" python3-numpy)
    if [ -n "$missing" ]; then
        (carom_ensure "${carom_python_packages[@]}" python3-numpy) 2>"$log" >&2 || {
            carom_no_python="these packages are missing: $missing"
            return 1
        }
    fi
    # The list of its packages is written once all are installed.
    if [ "$(cat "$env/needs" 2>/dev/null)" != "${carom_python_needs[*]}" ]; then
        rm -rf "$env"
        if ! /usr/bin/python3 -m venv --system-site-packages "$env" >"$log" 2>&1; then
            carom_no_python="venv cannot make an environment; see $PWD/$log"
            return 1
        fi
        local pip=("$env/bin/python" -m pip install --quiet --disable-pip-version-check)
        if ! "${pip[@]}" --retries 1 --timeout 15 "${carom_python_needs[@]}" >>"$log" 2>&1; then
            carom_no_python="pip cannot get ${carom_python_needs[*]}; see $PWD/$log"
            return 1
        fi
        printf '%s' "${carom_python_needs[*]}" >"$env/needs"
    fi
    carom_python=$PWD/$env/bin/python
}
