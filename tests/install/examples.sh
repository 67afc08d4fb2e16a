#!/usr/bin/env bash
# Installs a build into a folder of its own and uses it as a stranger would: the examples in C++ and C see the installed package
# only. Usage: examples.sh BUILD_DIR SOURCE_DIR C++_COMPILER
set -euo pipefail
build=$1 source=$2 compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "examples.sh: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$work/first" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
# The package may be moved; nothing in it may know where it was built.
mv "$work/first" "$work/carom"
if grep -rIl -e "$build" -e "$work/first" --include=*.cmake --include=*.pc --include=*.h "$work/carom"; then
    fail "these files name the folder of the build"
fi
library=$(find "$work/carom" -name 'libcarom.so' -printf '%h')
[ -n "$library" ] || fail "libcarom.so is not installed"
cp -r "$source/examples" "$work/examples"

echo "== C++"
cmake -G Ninja -S "$work/examples/cpp" -B "$work/cpp" -DCMAKE_PREFIX_PATH="$work/carom" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Debug >"$work/cpp.log" 2>&1 && cmake --build "$work/cpp" >>"$work/cpp.log" 2>&1 || { cat "$work/cpp.log"; exit 1; }
"$work/cpp/shot" | tee "$work/cpp.txt"
grep -q 'ball_ball *cue 1' "$work/cpp.txt" || fail "the C++ example met no ball"
# A later minor version of 0.x would be another interface.
sed -i 's/carom 0.1/carom 0.2/' "$work/examples/cpp/CMakeLists.txt"
if cmake -G Ninja -S "$work/examples/cpp" -B "$work/cpp2" -DCMAKE_PREFIX_PATH="$work/carom" >"$work/cpp2.log" 2>&1; then
    fail "version 0.2 was asked for and this one taken"
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
declared=$(grep -o 'carom_[a-z_]*(' "$work/carom/include/carom/carom.h" | tr -d '(' | sort -u)
[ "$(printf '%s\n' "$shown" | sort)" = "$declared" ] || fail "libcarom.so shows other symbols than carom.h declares:
$shown"
readelf -d "$library/libcarom.so" | grep -q 'SONAME.*libcarom\.so\.[0-9]*\.[0-9]*\]' || fail "the soname has no version"
# What is linked into another's library stays hidden there too.
if nm "$library/libcarom_engine.a" 2>/dev/null | grep -q ' T _ZN5carom8simulate'; then
    visibility=$(readelf -sW "$library/libcarom_engine.a" | awk '$8 ~ /^_ZN5carom8simulateERK/ && $7 != "UND" {print $6; exit}')
    [ "$visibility" = HIDDEN ] || fail "symbols of the static library are not hidden but $visibility"
fi

echo "== Program"
"$work/carom/bin/carom" --version
for file in man/man1/carom.1 bash-completion/completions/carom zsh/site-functions/_carom; do
    [ -s "$work/carom/share/$file" ] || fail "share/$file is not installed"
done
