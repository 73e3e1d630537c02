"""Measures tenfold against its peers, and against itself: see README.md."""

import argparse
import csv
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

import measure
import meshes
from peers import PEERS, AtOnce, Tenfold, Twin

HERE = Path(__file__).parent
ROOT = HERE.parent
SCENES = {p.stem: p for p in sorted((HERE / "scenes").glob("*.pbrt"))}
MESH = "mesh-1M"


def main():
    parser = argparse.ArgumentParser(prog="bench/run", description=__doc__)
    parser.add_argument("--tenfold", metavar="PROGRAM", help="the program [default: cargo build --release]")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="for all alike [default: %(default)s]")
    parser.add_argument("--runs", type=int, default=5, help="of each renderer, in turn [default: %(default)s]")
    parser.add_argument("--spp", type=int, default=256, help="samples a pixel [default: %(default)s]")
    parser.add_argument("--peers", help=f"with commas between [default: {','.join(PEERS)}]")
    parser.add_argument("--out", type=Path, default=HERE / "results", help="folder for the tables [default: bench/results]")
    commands = parser.add_subparsers(dest="command")
    noise = commands.add_parser("peers", help="the cost of a picture at equal noise (what is done without a command)")
    noise.add_argument("scenes", nargs="*", help=f"names or beginnings of {', '.join(SCENES)}, {MESH} [default: all]")
    scaling = commands.add_parser("scaling", help="one thread against all")
    scaling.add_argument("scenes", nargs="*", help="as for peers [default: all]")
    triangles = commands.add_parser("triangles", help="samples per second against the number of triangles")
    triangles.add_argument("--most", type=int, default=7, help="powers of ten up to this one [default: %(default)s]")
    commands.add_parser("lights", help="many small lamps against few")
    loading = commands.add_parser("loading", help="time to the first sample of a large mesh")
    loading.add_argument("--triangles", type=int, default=10_000_000, help="[default: %(default)s]")
    args = parser.parse_args()
    if args.tenfold is None:
        subprocess.run(["cargo", "build", "--release", "--locked", "--package", "tenfold"], cwd=ROOT, check=True)
        args.tenfold = ROOT / "target/release/tenfold"
    # The working directory of the renderers is of no matter: paths are absolute.
    args.tenfold = Path(args.tenfold).resolve()
    if args.peers is None:
        # All peers at once would fill the memory with ten million triangles.
        args.peers = "scalar_rgb,llvm_ad_rgb,cycles" if args.command == "triangles" else ",".join(PEERS)
    args.peers = [p for p in args.peers.split(",") if p]
    for unknown in set(args.peers) - set(PEERS):
        parser.error(f"unknown peer {unknown}: there are {', '.join(PEERS)}")
    start = time.perf_counter()
    {"scaling": scale, "triangles": count_triangles, "lights": count_lights, "loading": load}.get(
        args.command, compare)(args)
    print(f"{time.perf_counter() - start:.0f} s", file=sys.stderr)


def chosen(args):
    names = getattr(args, "scenes", None) or [*SCENES, MESH]
    for name in names:
        found = [s for s in [*SCENES, MESH] if s.startswith(name)]
        if not found:
            sys.exit(f"no scene begins with {name}: there are {', '.join([*SCENES, MESH])}")
        for scene in found:
            yield scene, meshes.stone_scene(1_000_000) if scene == MESH else SCENES[scene]


def openers(args, scene, threads=None, peers=None, samples=None):
    """Tenfold and the peers, each with a function that opens the scene."""
    threads, samples = threads or args.threads, samples or args.spp
    made = [("tenfold", lambda: Tenfold(args.tenfold, scene, threads, samples))]
    for name in args.peers if peers is None else peers:
        made.append((name, lambda name=name: Twin(name, scene, threads, samples)))
    return made


def compare(args):
    """The cost at equal noise, on all scenes."""
    rows = []
    for name, scene in chosen(args):
        for one in (series := measure.interleaved(openers(args, scene), args.spp, args.runs)):
            own = series[0]
            rows.append({
                "scene": name, "renderer": one.name, "seconds": one.time, "whole process": one.process_time,
                "M samples/s": one.rate / 1e6, "relvar": one.relvar, "cost": one.cost,
                "tenfold's cost / cost": own.cost / one.cost, "mean / tenfold's": one.mean / own.mean,
                "tiles' difference": measure.tile_difference(one.pictures, own.pictures),
            })
        table(rows[-len(series):])
    write(args, "peers", rows, f"{args.spp} samples a pixel, {args.threads} threads, medians of {args.runs} interleaved runs")


def scale(args):
    """How much faster all threads are than one."""
    rows = []
    for name, scene in chosen(args):
        for peer in ["tenfold", *args.peers]:
            pair = []
            for threads in (1, args.threads):
                found = [o for o in openers(args, scene, threads) if o[0] == peer]
                pair.append((f"{peer} {threads}", found[0][1]))
            if peer == "tenfold":
                pair.append(("at once", lambda: AtOnce(args.tenfold, scene, args.threads, args.spp)))
            series = measure.interleaved(pair, args.spp, args.runs)
            if len(series) == len(pair):
                def speed_up(times, work=1):
                    return statistics.median(work * a / b for a, b in zip(series[0].seconds, times.seconds))

                rows.append({"scene": name, "renderer": peer, "seconds, 1 thread": series[0].time,
                             f"seconds, {args.threads} threads": series[1].time, "speed-up": speed_up(series[1]),
                             "of as many programs": speed_up(series[2], args.threads) if peer == "tenfold" else None})
        table(rows)
    write(args, "scaling", rows, f"{args.spp} samples a pixel, medians of {args.runs} interleaved runs")


def count_triangles(args):
    """The same shape of ever more triangles."""
    rows = []
    for power in range(3, args.most + 1):
        series = measure.interleaved(openers(args, meshes.stone_scene(10**power)), args.spp, args.runs)
        for one in series:
            rows.append({"triangles": f"10^{power}", "renderer": one.name, "M samples/s": one.rate / 1e6,
                         "seconds": one.time, "loading": one.renderer.load_seconds,
                         "tenfold's time / time": series[0].time / one.time, "mean / tenfold's": one.mean / series[0].mean})
        table(rows[-len(series):])
    write(args, "triangles", rows, f"{args.spp} samples a pixel, {args.threads} threads, medians of {args.runs} interleaved runs")


def count_lights(args):
    """The same sum of light from ever more lamps."""
    rows = []
    for below, scene in (("a floor", meshes.confetti_scene), ("a stone of 10⁶ triangles", meshes.lit_stone_scene)):
        few = {}
        for count in (10, 1000, 100_000):
            for one in (series := measure.interleaved(openers(args, scene(count)), args.spp, args.runs)):
                few.setdefault(one.name, one)
                rows.append({"lights": count, "over": below, "renderer": one.name, "µs a sample": 1e6 / one.rate,
                             "relvar": one.relvar, "cost": one.cost, "time / time of 10": one.time / few[one.name].time,
                             "cost / cost of 10": one.cost / few[one.name].cost, "mean / tenfold's": one.mean / series[0].mean})
            table(rows[-len(series):])
    write(args, "lights", rows, f"{args.spp} samples a pixel, {args.threads} threads, medians of {args.runs} interleaved runs")


def load(args):
    """Time to the first sample: for tenfold of the whole program, for peers of what loads the scene and renders it, without
    the start of Python and the imports."""
    rows = []
    ply = meshes.stone_scene(args.triangles, 16, 12)
    size = (meshes.MADE / f"stone-{args.triangles}.ply").stat().st_size
    times = {name: [] for name, _ in openers(args, ply)}
    for seed in range(args.runs):
        for name, opener in openers(args, ply, samples=1):
            one = opener()
            render = one.render(seed)
            first = render.process_seconds or one.load_seconds + render.seconds
            times[name].append((first, one.load_seconds))
            one.close()
    for name, of_runs in times.items():
        first, loading = (statistics.median(column) for column in zip(*of_runs))
        rows.append({"scene": f"{args.triangles} triangles in binary PLY ({size / 1e6:.0f} MB)", "renderer": name,
                     "loading": loading, "to the first sample": first,
                     "tenfold's first / loading": statistics.median(t[0] for t in times["tenfold"]) / loading})
    inline = meshes.inline_scene(args.triangles // 10)
    size = inline.stat().st_size / 1e6
    own = Tenfold(args.tenfold, inline, args.threads, 1)
    reads, firsts = [], []
    for seed in range(args.runs):
        firsts.append(own.render(seed).process_seconds)
        reads.append(own.read_seconds)
    rows.append({"scene": f"{args.triangles // 10} triangles in the scene file ({size:.0f} MB)", "renderer": "tenfold",
                 "loading": own.load_seconds, "to the first sample": statistics.median(firsts),
                 "MB/s of the reader": size / statistics.median(reads)})
    write(args, "loading", rows, f"{args.threads} threads, medians of {args.runs} interleaved runs")


def shown(value):
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    return str(value)


def markdown(rows):
    columns = list(dict.fromkeys(column for row in rows for column in row))
    lines = [columns, ["---" if isinstance(rows[0].get(c), str) else "---:" for c in columns]]
    lines += [[shown(row.get(c)) for c in columns] for row in rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def table(rows):
    """What is known so far, for who waits."""
    print(markdown(rows), flush=True)


def write(args, name, rows, how):
    """The table as markdown, with how it was made, and as CSV."""
    args.out.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([args.tenfold, "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    with open("/proc/cpuinfo") as file:
        cpu = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), platform.processor())
    text = f"{version} on {cpu}, {time.strftime('%Y-%m-%d')}: {how}.\n\n{markdown(rows)}"
    (args.out / f"{name}.md").write_text(text)
    with open(args.out / f"{name}.csv", "w", newline="") as file:
        columns = list(dict.fromkeys(column for row in rows for column in row))
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)
    print(text)


if __name__ == "__main__":
    main()
