"""Makes a site of the sample factory: its drawing imported, its routes, a VLP-16 on the vehicle, and a scenario.

    sample_site.py MADORI DATA SITE [--drawing dxf|scan] [--scenario sample_factory] [--quiet-factory]
                   [--mount "type: lms1xx, x_m: 0.65, z_m: 0.25" ...] [--scenario-line "vlp16: {pitch_deg: 1}" ...]

With dxf the drawing is exact; with scan it is imported from a skewed scan and scaled by one dimension line.
SITE/scenario.yaml is data/scenarios/NAME.yaml, put where the imported drawing has its origin. Each --mount is a lidar
(the keys of site.yaml that it leaves out are 0) in the place of the VLP-16; a --scenario-line replaces the section of
its name, or adds it.
"""

import argparse
import csv
import pathlib
import re
import shutil
import subprocess


def shifted_routes(source, target, x_m, y_m):
    target.mkdir(parents=True, exist_ok=True)
    shutil.copy(source / "tree.csv", target / "tree.csv")
    with open(source / "path.csv", encoding="utf-8-sig") as old, open(target / "path.csv", "w") as new:
        rows = list(csv.reader(old))
        writer = csv.writer(new, lineterminator="\n")
        writer.writerow(rows[0])
        for row in rows[1:]:
            writer.writerow([row[0], f"{float(row[1]) + x_m:.4f}", f"{float(row[2]) + y_m:.4f}", *row[3:]])


def write_scenario(data, name, target, map_from_plan, quiet):
    lines = (data / f"scenarios/{name}.yaml").read_text().replace("../sample_factory", str(data.resolve() / "sample_factory"))
    lines = [line for line in lines.splitlines() if not (map_from_plan and line.startswith("map_from_plan"))]
    if quiet:  # nobody walks about
        lines = [line for line in lines if not re.match(r"movers:|  - \{kind: (person|forklift)", line)]
    target.write_text("\n".join(lines + ([map_from_plan] if map_from_plan else [])) + "\n")


def soak_scenario(data):
    """The text of the soak's scenario, for a folder elsewhere."""
    text = (data / "scenarios/soak/scenario.yaml").read_text()
    return text.replace("../../sample_factory", str(data.resolve() / "sample_factory"))


def set_section(text, section):
    """A top-level section of one line instead of the one of that name, or at the end."""
    key = section.split(":", 1)[0]
    kept, inside = [], False
    for line in text.splitlines():
        inside = line.startswith(f"{key}:") or (inside and line[:1] in (" ", "-"))
        if not inside:
            kept.append(line)
    return "\n".join(kept + [section]) + "\n"


def mount(site, lidars):
    """The lidars of site.yaml, each "type: ..., x_m: ..., ..."."""
    file = site / "site.yaml"
    listed = ", ".join(f"{{name: lidar {i + 1}, {{}}{lidar}}}".replace("{}", "".join(
        f"{key}: 0, " for key in ("x_m", "y_m", "z_m", "yaw_deg") if key not in lidar))
        for i, lidar in enumerate(lidars))
    file.write_text(set_section(file.read_text(), f"sensors: [{listed}]"))


def make_site(madori, data, site, drawing="dxf", scenario="sample_factory", quiet=False):
    """Returns the shift (x, y) of the site's Map frame against the factory frame, metres; (0, 0) of the scan."""
    shutil.rmtree(site, ignore_errors=True)
    sample = data / "sample_factory"
    if drawing == "scan":
        subprocess.run([madori, "demo", "--import-only", "--site", site, "--data", data], check=True,
                       stdout=subprocess.DEVNULL)
        write_scenario(data, scenario, site / "scenario.yaml", "", quiet)
        return 0.0, 0.0
    subprocess.run([madori, "import", sample / "factory.dxf", "--site", site], check=True, stdout=subprocess.DEVNULL)
    text = (site / "site.yaml").read_text()
    origin = re.search(r"Map origin is at x = (\S+), y = (\S+) of the drawing", text)
    x_m, y_m = (-float(number) * 0.001 for number in origin.groups())  # the drawing's unit is a millimetre
    shifted_routes(sample / "routes_factory", site / "routes", x_m, y_m)
    if "sensors:" not in text:
        with open(site / "site.yaml", "a") as file:
            file.write("sensors:\n  - {name: top, type: vlp16, x_m: 0.3, y_m: 0, z_m: 1.2, yaw_deg: 0}\n")
    shift = f"map_from_plan: {{x_m: {x_m:.4f}, y_m: {y_m:.4f}, yaw_deg: 0}}"
    write_scenario(data, scenario, site / "scenario.yaml", shift, quiet)
    return x_m, y_m


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("madori")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("site", type=pathlib.Path)
    parser.add_argument("--drawing", choices=["dxf", "scan"], default="dxf")
    parser.add_argument("--scenario", default="sample_factory")
    parser.add_argument("--quiet-factory", action="store_true")
    parser.add_argument("--mount", action="append", default=[], help="a lidar")
    parser.add_argument("--scenario-line", action="append", default=[], help="a section of the scenario")
    a = parser.parse_args()
    make_site(a.madori, a.data, a.site, a.drawing, a.scenario, a.quiet_factory)
    if a.mount:
        mount(a.site, a.mount)
    for line in a.scenario_line:
        (a.site / "scenario.yaml").write_text(set_section((a.site / "scenario.yaml").read_text(), line))
