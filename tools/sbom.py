#!/usr/bin/env python3
"""Writes the parts that a build of carom was made from, as CycloneDX 1.6:

    tools/sbom.py BUILD_DIR VERSION [ARCHIVE ...] > carom.cdx.json

The parts are read from the build itself: the headers that the compiler opened for the shipped targets (ninja
-t deps), and the shared libraries that the program and libcarom.so need (ldd). Each belongs to a Debian
package, whose version dpkg knows. The same build gives the same bytes: the only time in it is
SOURCE_DATE_EPOCH. Exit status 1: a file belongs to no package.
"""
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import uuid

# Parts of the build that are not shipped.
NOT_SHIPPED = ("tests/", "lab/", "python/")


def output_of(*command, **options):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def headers(build):
    """Files from outside the repository that were compiled into shipped targets."""
    found, shipped = set(), False
    for line in output_of("ninja", "-C", str(build), "-t", "deps").splitlines():
        if line and not line.startswith((" ", "ninja:")):
            shipped = not line.startswith(NOT_SHIPPED)
        elif shipped and line.startswith("    /"):
            path = os.path.realpath(line.strip())
            if path.startswith("/usr/"):
                found.add(path)
    return found


def libraries(build):
    """Shared libraries that the program and libcarom.so need directly."""
    found = set()
    for binary in [build / "carom", *sorted(build.glob("capi/libcarom.so"))]:
        needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]",
                                output_of("readelf", "-d", str(binary), env={**os.environ, "LC_ALL": "C"})))
        for name, path in re.findall(r"^\s*(\S+) (?:=> )?(\S*)", output_of("ldd", str(binary)), re.M):
            if name in needed and path.startswith("/"):
                found.add(os.path.realpath(path))
    return found


def owners(paths):
    """path -> package. dpkg may list a file under its name from before /usr was merged."""
    names = {name: path for path in paths for name in (path, path.removeprefix("/usr"))}
    text = subprocess.run(["dpkg-query", "-S", *sorted(names)], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL).stdout
    found = {}
    for line in text.splitlines():
        package, separator, name = line.partition(": ")
        if separator and name in names and not package.startswith("diversion "):
            found[names[name]] = package.split(",")[0].split(":")[0]
    return found


def distribution():
    values = dict(re.findall(r'^(\w+)="?([^"\n]*)"?$', pathlib.Path("/etc/os-release").read_text(), re.M))
    return values["ID"], f"{values['ID']}-{values.get('VERSION_ID', 'unstable')}"


def component(package, linked):
    name, version, source, architecture, homepage = output_of(
        "dpkg-query", "-W", "-f=${Package}|${Version}|${source:Package}|${Architecture}|${Homepage}\n",
        package).splitlines()[0].split("|")
    vendor, distro = distribution()
    encoded = version.replace("+", "%2B").replace(":", "%3A")
    purl = f"pkg:deb/{vendor}/{name}@{encoded}?arch={architecture}&distro={distro}"
    used = "shared library" if linked else "headers, or what the compiler links in"
    entry = {"type": "library", "bom-ref": purl, "name": name, "version": version, "purl": purl,
             "scope": "required", "properties": [{"name": "carom:debian-source", "value": source},
                                                 {"name": "carom:used-as", "value": used}]}
    if homepage:
        entry["externalReferences"] = [{"type": "website", "url": homepage}]
    return entry


def bom(build, version, archives):
    linked, compiled = libraries(build), headers(build)
    owner = owners(linked | compiled)
    orphans = sorted((linked | compiled) - set(owner))
    if orphans:
        sys.exit(f"sbom: no package owns {', '.join(orphans[:5])}; build with the distribution's packages")
    shared = {owner[path] for path in linked}
    components = [component(package, package in shared) for package in sorted(set(owner.values()))]
    own = {"type": "application", "bom-ref": f"pkg:generic/carom@{version}", "name": "carom",
           "version": version, "purl": f"pkg:generic/carom@{version}",
           "licenses": [{"license": {"id": "Apache-2.0"}}]}
    if archives:
        sums = {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in archives}
        own["components"] = [{"type": "file", "bom-ref": f"file:{path.name}", "name": path.name,
                              "hashes": [{"alg": "SHA-256", "content": sums[path]}]} for path in archives]
    document = {"$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json", "bomFormat": "CycloneDX",
                "specVersion": "1.6", "version": 1, "metadata": {"component": own}, "components": components,
                "dependencies": [
                    {"ref": own["bom-ref"], "dependsOn": [entry["bom-ref"] for entry in components]}]}
    if "SOURCE_DATE_EPOCH" in os.environ:
        time = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
        document["metadata"]["timestamp"] = time.strftime("%Y-%m-%dT%H:%M:%SZ")
    document["serialNumber"] = "urn:uuid:" + str(
        uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(document, sort_keys=True)))
    return document


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    made = bom(
        pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], [pathlib.Path(path) for path in sys.argv[3:]])
    print(json.dumps(made, indent=1, ensure_ascii=False))
