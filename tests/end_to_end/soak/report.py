#!/usr/bin/python3
"""Adds up the days that `soak --json FILE` has written: a table, and with --plot a picture."""
import argparse
import collections
import json


def spread(days, key):
    """Count, mean, 99th percentile and largest value of a Spread over all days, metres."""
    bins = collections.Counter()
    for day in days:
        for millimetres, count in day[key]["bins_mm"]:
            bins[millimetres] += count
    count = sum(bins.values())
    total = sum(day[key]["sum_m"] for day in days)
    p99, seen = 0.0, 0
    for millimetres in sorted(bins):
        seen += bins[millimetres]
        if seen >= 0.99 * count:
            p99 = (millimetres + 1) / 1000.0
            break
    within = sum(n for mm, n in bins.items() if mm < 20)
    return {"count": count, "mean": total / max(count, 1), "p99": p99,
            "most": max((day[key]["most_m"] for day in days), default=0.0), "within_2cm": within}


def both(days, key):
    return [entry for day in days for entry in day[key]]


def rows(days):
    add = lambda key: sum(day[key] for day in days)
    helped = both(days, "help")
    in_vain = [h for h in helped if not h["every_way_blocked"]]
    found = sorted(both(days, "found_after_s"))
    off, pose, goal = (spread(days, key) for key in ("off_route", "pose_error", "goal_error"))
    degrees = both(days, "goal_error_deg")
    stood = collections.Counter()
    for day in days:
        stood.update(day["standstill_s"])
    yield "days", f"{len(days)}"
    yield "delivered", f"{add('delivered')} of {add('asked')}"
    yield "collisions while the vehicle moved", f"{len(both(days, 'collisions_moving'))}"
    yield "run into by others while standing", f"{len(both(days, 'collisions_standing'))}"
    yield "near misses (within 0.1 m while moving)", f"{add('near_misses')}"
    yield "manual help, every way blocked", f"{len(helped) - len(in_vain)}"
    yield "manual help, other", f"{len(in_vain)}"
    yield "kidnappings found", f"{len(found)} of {add('kidnapped')}"
    if found:
        yield "found after", f"median {found[len(found) // 2]:.1f} s, longest {found[-1]:.1f} s"
    yield "drop-outs survived without help", f"{add('dropouts_survived')} of {add('dropouts')}"
    yield "persons sent across, pallets put down", f"{add('persons')}, {add('pallets')}"
    yield "detours, other routes", f"{add('detours')}, {add('other_routes')}"
    yield "driven", f"{add('driven_m') / 1000.0:.1f} km in {add('simulated_s') / 3600.0:.1f} h"
    yield "from the route", f"mean {off['mean']:.4f} m, p99 {off['p99']:.3f} m, most {off['most']:.3f} m"
    yield "pose while localized", f"mean {pose['mean']:.4f} m, p99 {pose['p99']:.3f} m, most {pose['most']:.3f} m"
    yield "localized but more than 0.5 m off", f"{add('sure_but_wrong_s'):.1f} s"
    yield "stop at the goal", (f"{goal['within_2cm']} of {goal['count']} within 0.02 m, p99 {goal['p99']:.3f} m, "
                               f"most {goal['most']:.3f} m; {sum(d <= 1.0 for d in degrees)} of {len(degrees)} within 1 deg")
    yield "memory of the process", f"{days[0]['memory_kib'] / 1024:.0f} MiB after the first day, {max(d['memory_kib'] for d in days) / 1024:.0f} MiB at most"
    yield "madori.db", f"{max(day['database_bytes'] for day in days) / 1e6:.1f} MB at most"
    yield "speed", f"{add('simulated_s') / max(add('cpu_s'), 1e-9):.0f} x real time of one core"
    for cause, seconds in stood.most_common(12):
        yield f"stood: {cause}", f"{seconds / 60.0:.1f} min"


def plot(days, file):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, 2, figsize=(12, 7))
    numbers = [day["day"] for day in days]
    total, curve = 0, []
    for day in days:
        total += day["delivered"]
        curve.append(total)
    axes[0, 0].step(numbers, curve, where="post")
    axes[0, 0].set_title(f"Deliveries: {total} of {sum(day['asked'] for day in days)}")
    axes[0, 0].set_xlabel("day")
    means = [1000 * day["off_route"]["sum_m"] / max(day["off_route"]["count"], 1) for day in days]
    axes[0, 1].plot(numbers, means, "o-", markersize=3, label="mean")
    axes[0, 1].set_title("Distance from the route, mean of each day (mm)")
    axes[0, 1].set_xlabel("day")
    axes[0, 1].set_ylim(bottom=0)
    axes[1, 0].hist(both(days, "delivery_s"), bins=60)
    axes[1, 0].set_title("Duration of a delivery (s)")
    found = both(days, "found_after_s")
    axes[1, 1].hist(found, bins=20)
    axes[1, 1].set_title(f"Kidnapped: found again after (s), {len(found)} of {sum(d['kidnapped'] for d in days)}")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+", help="what soak --json has written")
    parser.add_argument("--plot", help="a picture to write (PNG)")
    parser.add_argument("--details", action="store_true", help="every failure, collision and help")
    arguments = parser.parse_args()
    days = {}
    for name in arguments.files:
        with open(name, encoding="utf-8") as lines:
            for line in lines:
                day = json.loads(line)
                days[day["day"]] = day
    days = [days[number] for number in sorted(days)]
    print("| what | figure |\n| --- | --- |")
    for what, figure in rows(days):
        print(f"| {what} | {figure} |")
    if arguments.details:
        for key in ("undelivered", "collisions_moving", "collisions_standing"):
            for text in both(days, key):
                print(f"{key}: {text}")
        for helped in both(days, "help"):
            print(f"help: {helped}")
    if arguments.plot:
        plot(days, arguments.plot)


if __name__ == "__main__":
    main()
