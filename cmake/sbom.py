#!/usr/bin/env python3
"""SPDX 2.3 document of what a program is linked with: every shared library that it loads, the Debian package and the
version it comes from.

    cmake/sbom.py build/release/madori [--out madori.spdx.json]
"""

import argparse
import datetime
import hashlib
import json
import pathlib
import re
import subprocess

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("program", type=pathlib.Path)
parser.add_argument("--out", type=pathlib.Path)
arguments = parser.parse_args()


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False).stdout


def libraries(program):
    """Paths of the libraries that the loader takes, without the kernel's own."""
    return sorted({pathlib.Path(m) for m in re.findall(r"=> (/\S+)|^\s*(/\S+) \(", run("ldd", program), re.M) for m in m if m})


def packages_of(files):
    """File -> Debian package that holds it, asked once for all: dpkg reads its whole list each time."""
    names = {}
    for file in files:  # a merged /usr: packages know their files by either name
        for path in (file, file.resolve()):
            for name in (str(path), str(path).removeprefix("/usr"), "/usr" + str(path)):
                names[name] = file
    holders = {}
    for line in run("dpkg-query", "-S", *names).splitlines():
        holder, _, path = line.rpartition(": ")
        if path in names and not holder.startswith("diversion"):
            holders[names[path]] = holder.split(",")[0].strip()
    return holders


def facts_of(packages):
    """Package -> (name, version, source package, home page)."""
    shown = run("dpkg-query", "-W", "-f", "${binary:Package}\t${Package}\t${Version}\t${source:Package}\t${Homepage}\n", *packages)
    facts = {}
    for line in shown.splitlines():
        full, *fact = line.split("\t")
        facts[full] = facts[full.split(":")[0]] = fact
    return facts


def licence_of(package):
    """The licences that Debian's copyright file names, as text: they are not all SPDX's names."""
    file = pathlib.Path(f"/usr/share/doc/{package}/copyright")
    if not file.exists():
        return "NOASSERTION"
    names = re.findall(r"^License: *(\S[^\n]*)$", file.read_text(errors="replace"), re.M)
    return "see Debian's copyright file: " + "; ".join(sorted(set(names))[:12]) if names else "see Debian's copyright file"


def spdx_id(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def main():
    program = arguments.program.resolve()
    version = run(program, "version").strip().rpartition(" ")[2] or "unknown"
    digest = hashlib.sha256(program.read_bytes()).hexdigest()
    own = {"SPDXID": "SPDXRef-madori", "name": "madori", "versionInfo": version, "downloadLocation": "NOASSERTION",
           "filesAnalyzed": False, "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
           "checksums": [{"algorithm": "SHA256", "checksumValue": digest}]}
    packages, unknown = {}, []
    holders = packages_of(libraries(program))
    facts = facts_of(sorted(set(holders.values())))
    for library in libraries(program):
        if holders.get(library) not in facts:
            unknown.append(str(library))
            continue
        name, its_version, source, homepage = facts[holders[library]]
        entry = packages.setdefault(name, {
            "SPDXID": spdx_id(name), "name": name, "versionInfo": its_version, "supplier": "Organization: Debian",
            "downloadLocation": homepage or "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
            "licenseDeclared": "NOASSERTION", "licenseComments": licence_of(name), "copyrightText": "NOASSERTION", "comment": "",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}@{its_version}?source={source}"}]})
        entry["comment"] = (entry["comment"] + " " + library.name).strip()
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"madori-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/madori-{version}-{digest[:16]}",
        "creationInfo": {"created": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
                         "creators": ["Tool: madori-sbom"]},
        "packages": [own, *packages.values()],
        "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-madori"},
                          *({"spdxElementId": "SPDXRef-madori", "relationshipType": "DYNAMIC_LINK", "relatedSpdxElement": p["SPDXID"]}
                            for p in packages.values())]}
    text = json.dumps(document, indent=1) + "\n"
    if arguments.out:
        arguments.out.write_text(text)
        print(f"{arguments.out}: {len(packages)} packages")
    else:
        print(text, end="")
    if unknown:
        raise SystemExit("of no Debian package: " + ", ".join(unknown))


main()
