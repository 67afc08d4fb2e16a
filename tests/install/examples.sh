#!/usr/bin/env bash
# Installs a build into its own folder and uses it as an outside user would: the C++ and C examples see only
# the installed package. Usage: examples.sh BUILD_DIR SOURCE_DIR C++_COMPILER
#    or: examples.sh --installed PREFIX SOURCE_DIR C++_COMPILER for an existing installation, such as a system
# package.
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
    cmake --install "$build" --prefix "$work/first" >"$work/install.log" \
        || { cat "$work/install.log"; exit 1; }
    # The package may be moved, so it must not contain the path of the build.
    mv "$work/first" "$work/carom"
    prefix=$work/carom
    texts=(--include=*.cmake --include=*.pc --include=*.cps --include=*.h)
    if grep -rIl -e "$build" -e "$work/first" "${texts[@]}" "$prefix"; then
        fail "these files contain the path of the build"
    fi
fi
library=$(find "$prefix"/lib* -name 'libcarom.so' -printf '%h')
[ -n "$library" ] || fail "libcarom.so is not installed"
cp -r "$source/examples" "$work/examples"

echo "== C++"
{
    cmake -G Ninja -S "$work/examples/cpp" -B "$work/cpp" -DCMAKE_PREFIX_PATH="$prefix" \
        -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug && cmake --build "$work/cpp"
} >"$work/cpp.log" 2>&1 || { cat "$work/cpp.log"; exit 1; }
"$work/cpp/shot" | tee "$work/cpp.txt"
grep -q 'ball_ball *cue 1' "$work/cpp.txt" || fail "the C++ example has no impact of the two balls"
# A later minor version of 0.x may change the interface, so it must be rejected.
next=$(sed -n 's/.*find_package(carom 0\.\([0-9]*\) .*/\1/p' "$work/examples/cpp/CMakeLists.txt")
next=0.$((next + 1))
sed -i "s/find_package(carom [0-9.]*/find_package(carom $next/" "$work/examples/cpp/CMakeLists.txt"
if cmake -G Ninja -S "$work/examples/cpp" -B "$work/cpp2" -DCMAKE_PREFIX_PATH="$prefix" \
    >"$work/cpp2.log" 2>&1; then
    fail "find_package(carom $next) accepted this version"
fi

echo "== C++ by pkg-config"
export PKG_CONFIG_PATH="$library/pkgconfig"
flags=$(pkg-config --cflags --libs carom-engine)
"$compiler" -std=c++20 "$work/examples/cpp/main.cpp" $flags -o "$work/shot_pc"
"$work/shot_pc" | cmp - "$work/cpp.txt" || fail "the program built with pkg-config prints something else"

echo "== C"
flags=$(pkg-config --cflags --libs carom)
cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$work/examples/c/main.c" $flags -o "$work/shot_c"
export LD_LIBRARY_PATH="$library"
"$work/shot_c" | tee "$work/c.txt"
grep -q 'refused: .*overlap' "$work/c.txt" || fail "the bad scene in the C example was accepted"
cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$work/examples/c/nine_ball.c" $flags -lm -o "$work/nine_ball"
"$work/nine_ball" "$prefix/share/carom/scenes/nine_ball_break.toml" | tail -1 | grep -q 'player [01] wins' \
    || fail "nobody won the nine-ball game of the C example"

# Both languages saw the same shot; tests/python compares the Python example.
for text in cpp c; do grep ' s  [a-z]' "$work/$text.txt" >"$work/$text.events"; done
cmp "$work/cpp.events" "$work/c.events"

echo "== Symbols"
shown=$(nm -D --defined-only "$library/libcarom.so" | awk '{print $3}')
declared=$(grep -o 'carom_[a-z_]*(' "$prefix/include/carom/carom.h" | tr -d '(' | sort -u)
[ "$(printf '%s\n' "$shown" | sort)" = "$declared" ] \
    || fail "libcarom.so exports other symbols than carom.h declares:
$shown"
readelf -d "$library/libcarom.so" | grep -q 'SONAME.*libcarom\.so\.[0-9]*\.[0-9]*\]' \
    || fail "the soname has no version"
# Symbols must also stay hidden if another library links the static one.
if nm "$library/libcarom_engine.a" 2>/dev/null | grep -q ' T _ZN5carom8simulate'; then
    find='$8 ~ /^_ZN5carom8simulateERK/ && $7 != "UND" {print $6; exit}'
    visibility=$(readelf -sW "$library/libcarom_engine.a" | awk "$find")
    [ "$visibility" = HIDDEN ] || fail "symbols of the static library are $visibility instead of HIDDEN"
fi

echo "== Program"
"$prefix/bin/carom" --version
for file in man/man1/carom.1 bash-completion/completions/carom; do
    # System packages compress the man page.
    [ -s "$prefix/share/$file" ] || [ -s "$prefix/share/$file.gz" ] || fail "share/$file is not installed"
done
zsh=$prefix/share/zsh
[ -s "$zsh/site-functions/_carom" ] || [ -s "$zsh/vendor-completions/_carom" ] \
    || fail "the completions for zsh are not installed"

"$prefix/bin/carom" check "$prefix/share/carom/scenes/hello.toml" >"$work/check.txt" \
    || { cat "$work/check.txt"; fail "an installed scene is refused"; }
schemas=$(cd "$prefix/share/carom" && echo *.json)
[ "$schemas" = "record.schema.json scene.schema.json" ] || fail "the schemas are not installed"

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
        assert os.path.exists(path), f"carom.cps: {name}: {path} does not exist"
    for word in component.get("requires", []) + component.get("link_requires", []):
        package_name, part = word.split(":")
        known = package["requires"] if package_name else package["components"]
        assert (package_name or part) in known, f"carom.cps: {name}: {word}"
# Definitions that CMake's users get must also reach users of this file.
definition = re.search(r'INTERFACE_COMPILE_DEFINITIONS "(\w+)=(\w+)"', targets)
assert package["components"]["engine"]["definitions"]["*"] == {definition[1]: definition[2]}
print(f"carom.cps: {len(exported)} components, all of their files exist")
END
