"""The add-on's zip against the rules of Blender 4.2 and later for extensions, and of Blender 3 for add-ons.

Blender 4.2 is in no Debian package: this holds what its manual asks for.  manifest_test.py ZIP VERSION
"""
import ast
import re
import sys
import zipfile

try:
    import tomllib
except ImportError:
    print("skipped: Python 3.11 is needed to read TOML")
    sys.exit(77)

TAGS = {"3D View", "Add Curve", "Add Mesh", "Animation", "Bake", "Camera", "Compositing", "Development", "Game Engine",
        "Geometry Nodes", "Grease Pencil", "Import-Export", "Lighting", "Material", "Mesh", "Modeling", "Node", "Object",
        "Paint", "Physics", "Pipeline", "Render", "Rigging", "Scene", "Sculpt", "Sequencer", "System", "Text Editor",
        "Tracking", "User Interface", "UV"}
PLATFORMS = {"windows-x64", "windows-arm64", "macos-x64", "macos-arm64", "linux-x64", "linux-arm64"}
PERMISSIONS = {"files", "network", "clipboard", "camera", "microphone"}
REQUIRED = ("schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min", "license")
failures = []


def check(condition, text):
    if not condition:
        failures.append(text)


def terse(text):
    """Blender's rule for short texts: one line, not long, no full stop."""
    return 0 < len(text) <= 64 and text == text.strip() and text.isprintable() and (text[-1].isalnum() or text[-1] in ")]}")


def check_manifest(manifest):
    for key in REQUIRED:
        check(manifest.get(key), f"{key} is missing")
    check(manifest["schema_version"] == "1.0.0", "schema_version")
    check(re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", manifest["id"]), "id is a plain Python name")
    check(re.fullmatch(r"\d+\.\d+\.\d+", manifest["version"]), "version is major.minor.patch")
    check(tuple(map(int, manifest["blender_version_min"].split("."))) >= (4, 2, 0), "extensions begin with Blender 4.2")
    check(manifest["type"] == "add-on", "type")
    check(terse(manifest["tagline"]), "tagline: at most 64 letters, no punctuation at its end")
    check(set(manifest["tags"]) <= TAGS, f"unknown tags: {set(manifest['tags']) - TAGS}")
    check(all(re.fullmatch(r"SPDX:[A-Za-z0-9.+-]+", one) for one in manifest["license"]), "licences are SPDX:...")
    check(manifest["platforms"] and set(manifest["platforms"]) <= PLATFORMS, f"platforms: {manifest['platforms']}")
    check(set(manifest["permissions"]) <= PERMISSIONS, "unknown permissions")
    check(all(terse(why) for why in manifest["permissions"].values()), "permissions: short reasons without a full stop")


def check_sources(archive, top, manifest):
    init = ast.parse(archive.read(f"{top}/__init__.py"))
    info = next(ast.literal_eval(node.value) for node in init.body
                if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
    check(".".join(map(str, info["version"])) == manifest["version"], "bl_info and manifest are of one version")
    check(info["blender"] < (4, 0, 0), "bl_info lets Blender 3 in")
    for name in archive.namelist():
        if not name.endswith(".py"):
            continue
        text = archive.read(name).decode()
        check("sys.path" not in text, f"{name}: extensions leave sys.path alone")
        for node in ast.walk(ast.parse(text)):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module]
            check(not any(n.split(".")[0] in {"focal", "focal_addon"} for n in names),
                  f"{name}: an extension's own modules are imported relative to it")


def main(path, version):
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        tops = {name.split("/")[0] for name in names}
        check(len(tops) == 1, f"one folder at the top, not {tops}")
        top = tops.pop()
        manifest = tomllib.loads(archive.read(f"{top}/blender_manifest.toml").decode())
        check_manifest(manifest)
        check(manifest["version"] == version, f"the version is focal's: {version}")
        check_sources(archive, top, manifest)
        check(manifest["license"][0] == "SPDX:GPL-3.0-or-later", "add-ons are under the GPL")
        check("GNU GENERAL PUBLIC LICENSE" in archive.read(f"{top}/LICENSE").decode()[:200], "and its text is inside")
        check("Apache License" in archive.read(f"{top}/focal/LICENSE").decode()[:200], "so is that of the engine")
        check(f"{top}/focal/THIRD_PARTY.md" in names, "and what the engine is built from")
        check({f"{top}/templates/{name}.json" for name in ("humanoid", "quadruped", "hand")} <= set(names), "templates are inside")
        check(not any("__pycache__" in name for name in names), "no caches inside")
        libraries = [n.rsplit("/", 1)[1] for n in names if re.search(r"\.(so|dll|dylib)(\.\d+)*[a-z]?$", n)]
        check(any("focal" in n for n in libraries), f"focal's library is inside: {libraries}")
    print("\n".join(failures) or f"{path.rsplit('/', 1)[-1]}: every rule is kept, {len(names)} files")
    return bool(failures)


sys.exit(main(*sys.argv[1:]))
