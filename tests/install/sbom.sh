#!/usr/bin/env bash
# What tools/sbom.py says of a build is what the build was made of, twice the same. Usage: sbom.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build=$1 source=$2
command -v dpkg-query >/dev/null && command -v ninja >/dev/null || { echo "skipped: this is no Debian, or ninja is missing"; exit 77; }
[ -f "$build/build.ninja" ] || { echo "skipped: $build was not made by ninja"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export SOURCE_DATE_EPOCH=1700000000
python3 "$source/tools/sbom.py" "$build" 1.2.3 "$source/LICENSE" >"$work/one.json"
python3 "$source/tools/sbom.py" "$build" 1.2.3 "$source/LICENSE" | cmp - "$work/one.json"
python3 - "$work/one.json" "$source/LICENSE" <<'END'
import hashlib, json, subprocess, sys
bom = json.load(open(sys.argv[1]))
assert (bom["bomFormat"], bom["specVersion"]) == ("CycloneDX", "1.6")
assert bom["metadata"]["timestamp"] == "2023-11-14T22:13:20Z", bom["metadata"]["timestamp"]
own = bom["metadata"]["component"]
assert own["version"] == "1.2.3"
assert own["components"][0]["hashes"][0]["content"] == hashlib.sha256(open(sys.argv[2], "rb").read()).hexdigest()
versions = {entry["name"]: entry["version"] for entry in bom["components"]}
# Those that the sources include or link; what only the tests use is not there.
for package in ("libeigen3-dev", "libbox2d-dev", "libtomlplusplus-dev", "libfmt-dev", "nlohmann-json3-dev", "libcli11-dev", "libpng-dev", "zlib1g-dev", "libc6"):
    there = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], text=True, stdout=subprocess.PIPE).stdout
    assert versions.get(package) == there, (package, versions.get(package), there)
assert not [name for name in versions if "gtest" in name or "googletest" in name], versions
linked = [entry["name"] for entry in bom["components"] if entry["properties"][1]["value"] == "shared library"]
assert any(name.startswith("libpng16") for name in linked), linked
references = [entry["bom-ref"] for entry in bom["components"]]
assert len(references) == len(set(references)) and bom["dependencies"][0]["dependsOn"] == references
print(f"sbom: {len(versions)} packages, {len(linked)} of them shared libraries")
END
