#!/usr/bin/env bash
# Installs a build into a folder of its own and uses it as a stranger would: the examples in C++ and C see the installed package
# only. Usage: examples.sh BUILD_DIR SOURCE_DIR C++_COMPILER
# examples.sh --installed PREFIX SOURCE_DIR C++_COMPILER uses what is installed already, by a system's package.
set -euo pipefail
build=
prefix=
if [ "$1" = --installed ]; then
    prefix=$2
    shift
else
    build=$1
fi
source=$2 compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "examples.sh: $*" >&2; exit 1; }

if [ -n "$build" ]; then
    cmake --install "$build" --prefix "$work/first" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
    # The package may be moved; nothing in it may know where it was built.
    mv "$work/first" "$work/carom"
    prefix=$work/carom
    if grep -rIl -e "$build" -e "$work/first" --include=*.cmake --include=*.pc --include=*.cps --include=*.h "$prefix"; then
        fail "these files name the folder of the build"
    fi
fi
library=$(find "$prefix"/lib* -name 'libcarom.so' -printf '%h')
[ -n "$library" ] || fail "libcarom.so is not installed"
cp -r "$source/examples" "$work/examples"

echo "== C++"
cmake -G Ninja -S "$work/examples/cpp" -B "$work/cpp" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Debug >"$work/cpp.log" 2>&1 && cmake --build "$work/cpp" >>"$work/cpp.log" 2>&1 || { cat "$work/cpp.log"; exit 1; }
"$work/cpp/shot" | tee "$work/cpp.txt"
grep -q 'ball_ball *cue 1' "$work/cpp.txt" || fail "the C++ example met no ball"
# A later minor version of 0.x would be another interface.
next=$(sed -n 's/.*find_package(carom 0\.\([0-9]*\) .*/\1/p' "$work/examples/cpp/CMakeLists.txt")
next=0.$((next + 1))
sed -i "s/find_package(carom [0-9.]*/find_package(carom $next/" "$work/examples/cpp/CMakeLists.txt"
if cmake -G Ninja -S "$work/examples/cpp" -B "$work/cpp2" -DCMAKE_PREFIX_PATH="$prefix" >"$work/cpp2.log" 2>&1; then
    fail "version $next was asked for and this one taken"
fi

echo "== C++ by pkg-config"
export PKG_CONFIG_PATH="$library/pkgconfig"
"$compiler" -std=c++20 "$work/examples/cpp/main.cpp" $(pkg-config --cflags --libs carom-engine) -o "$work/shot_pc"
"$work/shot_pc" | cmp - "$work/cpp.txt" || fail "pkg-config gave another program"

echo "== C"
cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$work/examples/c/main.c" $(pkg-config --cflags --libs carom) -o "$work/shot_c"
export LD_LIBRARY_PATH="$library"
"$work/shot_c" | tee "$work/c.txt"
grep -q 'refused: .*overlap' "$work/c.txt" || fail "the C example was not refused"

# Both languages saw the same shot. tests/python compares the Python example.
for text in cpp c; do grep ' s  [a-z]' "$work/$text.txt" >"$work/$text.events"; done
cmp "$work/cpp.events" "$work/c.events"

echo "== Symbols"
shown=$(nm -D --defined-only "$library/libcarom.so" | awk '{print $3}')
declared=$(grep -o 'carom_[a-z_]*(' "$prefix/include/carom/carom.h" | tr -d '(' | sort -u)
[ "$(printf '%s\n' "$shown" | sort)" = "$declared" ] || fail "libcarom.so shows other symbols than carom.h declares:
$shown"
readelf -d "$library/libcarom.so" | grep -q 'SONAME.*libcarom\.so\.[0-9]*\.[0-9]*\]' || fail "the soname has no version"
# What is linked into another's library stays hidden there too.
if nm "$library/libcarom_engine.a" 2>/dev/null | grep -q ' T _ZN5carom8simulate'; then
    visibility=$(readelf -sW "$library/libcarom_engine.a" | awk '$8 ~ /^_ZN5carom8simulateERK/ && $7 != "UND" {print $6; exit}')
    [ "$visibility" = HIDDEN ] || fail "symbols of the static library are not hidden but $visibility"
fi

echo "== Program"
"$prefix/bin/carom" --version
for file in man/man1/carom.1 bash-completion/completions/carom; do
    # A system's package has the man page compressed.
    [ -s "$prefix/share/$file" ] || [ -s "$prefix/share/$file.gz" ] || fail "share/$file is not installed"
done
[ -s "$prefix/share/zsh/site-functions/_carom" ] || [ -s "$prefix/share/zsh/vendor-completions/_carom" ] || fail "the completions of zsh are not installed"

"$prefix/bin/carom" check "$prefix/share/carom/scenes/hello.toml" >"$work/check.txt" || { cat "$work/check.txt"; fail "an installed scene is refused"; }
[ "$(cd "$prefix/share/carom" && echo *.json)" = "record.schema.json scene.schema.json" ] || fail "the schemas are not installed"

echo "== Common Package Specification"
python3 - "$library" "$prefix" "$("$prefix/bin/carom" --version)" <<'END'
import json, os, re, sys
library, prefix, version = sys.argv[1:]
package = json.load(open(f"{library}/cps/carom.cps"))
assert f"carom {package['version']}" == version, (package["version"], version)
assert package["cps_path"].replace("@prefix@", prefix) == f"{library}/cps", package["cps_path"]
targets = "".join(open(f"{library}/cmake/carom/carom{part}-targets.cmake").read() for part in ("", "-render"))
exported = set(re.findall(r"add_library\(carom::(\w+) ", targets))
assert set(package["components"]) == exported, (sorted(package["components"]), sorted(exported))
for name, component in package["components"].items():
    for path in [component["location"], *component["includes"]]:
        path = path.replace("@prefix@", prefix)
        assert os.path.exists(path), f"carom.cps: {name}: there is no {path}"
    for word in component.get("requires", []) + component.get("link_requires", []):
        package_name, part = word.split(":")
        assert (part in package["components"]) if package_name == "" else (package_name in package["requires"]), f"carom.cps: {name}: {word}"
# What CMake's users get by a definition, those of this file get as well.
definition = re.search(r'INTERFACE_COMPILE_DEFINITIONS "(\w+)=(\w+)"', targets)
assert package["components"]["engine"]["definitions"]["*"] == {definition[1]: definition[2]}
print(f"carom.cps: {len(exported)} components, all of their files are there")
END
