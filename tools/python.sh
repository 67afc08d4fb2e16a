# Sourced after tools/packages.sh: an environment in build/python-env to build and test the Python package in. It sees the system's packages.

# What the tests need from PyPI beside what builds the package (pyproject.toml names that, too). numpy: its types are checked against, and those
# of 2.2, which Debian 13 has, know less.
carom_python_needs=('nanobind>=2.9' 'pytest>=8' 'mypy>=1.11' 'numpy>=2.4' pyarrow dask distributed duckdb 'matplotlib>=3.9' pandas 'gymnasium>=1.1' 'pettingzoo>=1.25')

# carom_make_python_env: sets carom_python to the interpreter of the environment; or fails and says why in carom_no_python.
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
    # The list of what is in it stands there only when all of it is.
    if [ "$(cat "$env/needs" 2>/dev/null)" != "${carom_python_needs[*]}" ]; then
        rm -rf "$env"
        if ! /usr/bin/python3 -m venv --system-site-packages "$env" >"$log" 2>&1; then
            carom_no_python="there is no venv ($PWD/$log)"
            return 1
        fi
        if ! "$env/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 --timeout 15 "${carom_python_needs[@]}" >>"$log" 2>&1; then
            carom_no_python="pip cannot get ${carom_python_needs[*]} ($PWD/$log)"
            return 1
        fi
        printf '%s' "${carom_python_needs[*]}" >"$env/needs"
    fi
    carom_python=$PWD/$env/bin/python
}
