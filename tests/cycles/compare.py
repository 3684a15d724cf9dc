#!/usr/bin/python3
"""Holds Lucerna against Blender's Cycles on one scene: renders it with both, compares, prints one JSON line.

  tests/cycles/compare.py scenes/cornell/cornell.gltf --size 256x256 --samples 256 --program build/release/bin/lucerna

  --lucerna FILE.exr     compare this picture instead of rendering one
  --cycles FILE.exr      compare with this picture instead of running Blender
  --second FILE.exr      a second, independent Cycles picture (other seed), or `render` to make one: then the relative
                         MSE is also given less the reference's own noise, mean((t - r1)(t - r2) / (r^2 + 0.01))
  --leave-out X0,Y0,X1,Y1   pixels left out of every figure (may be repeated), e.g. the band that README.md names
  --keep DIR             where the pictures are kept (default: a temporary folder)

Figures: `mean` of both pictures and their `ratio` (Lucerna / Cycles) a channel; `blocks`: the ratio of 16x16 blocks
(mean of the three channels) at 5, 50 and 95 per cent, of blocks brighter than 1 % of the mean; `relmse` with eps = 0.01,
plain and without the worst 0.1 % of the pixels; samples/s of both, of the rendering alone.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import exr  # noqa: E402


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("scene")
    p.add_argument("--size", default="320x180")
    p.add_argument("--samples", type=int, default=128, help="of Lucerna; of Cycles too unless --cycles-samples is given")
    p.add_argument("--cycles-samples", type=int)
    p.add_argument("--camera", default="")
    p.add_argument("--depth", type=int, default=64)
    p.add_argument("--seed", type=int, default=0)
    p.add_argument("--threads", type=int, default=2)
    p.add_argument("--program", default=os.path.join(HERE, "..", "..", "build", "release", "bin", "lucerna"))
    p.add_argument("--set", action="append", default=[], help="KEY=VALUE passed on to Lucerna")
    p.add_argument("--lucerna")
    p.add_argument("--cycles")
    p.add_argument("--second")
    p.add_argument("--leave-out", action="append", default=[])
    p.add_argument("--keep")
    return p.parse_args()


def run_cycles(a, out, seed):
    command = ["blender", "-b", "--factory-startup", "-P", os.path.join(HERE, "blender_scene.py"), "--", a.scene, out,
               "--size", a.size, "--samples", str(a.cycles_samples or a.samples), "--depth", str(a.depth),
               "--seed", str(seed), "--threads", str(a.threads)]
    if a.camera:
        command += ["--camera", a.camera]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in done.stdout.splitlines():
        if line.startswith("CYCLES "):
            return json.loads(line[7:])
    sys.exit(done.stdout[-3000:] + "\ncompare.py: Blender did not render")


def run_lucerna(a, out, stats):
    command = [a.program, "render", a.scene, "-o", out, "--size", a.size, "--samples", str(a.samples),
               "--seed", str(a.seed), "--stats", stats, "--quiet", "--set", f"path.max_depth={a.depth}"]
    if a.camera:
        command += ["--camera", a.camera]
    for s in a.set:
        command += ["--set", s]
    subprocess.run(command, check=True)
    found = json.load(open(stats))
    width, height = (int(v) for v in a.size.split("x"))
    return {"samples": a.samples, "render_s": found["wall_s"], "tracer": found.get("tracer"),
            "device": found.get("device"), "samples_per_s": round(a.samples * width * height / found["wall_s"], 1)}


def block_ratios(ours, theirs, keep, size=16):
    """Ratio of block means, of blocks that are whole, all kept and not black."""
    h, w, _ = ours.shape
    h, w = h // size * size, w // size * size

    def blocks(x):
        return x[:h, :w].reshape(h // size, size, w // size, size, -1).mean(axis=(1, 3, 4))

    o, t = blocks(ours), blocks(theirs)
    whole = blocks(keep[:, :, None].astype(float)) == 1
    good = whole & (t > 0.01 * theirs.mean())
    return (o[good] / t[good]) if good.any() else np.array([np.nan])


def figures(ours, theirs, keep, second=None, eps=0.01):
    o, t = ours[keep], theirs[keep]
    out = {"mean": {"lucerna": o.mean(axis=0).round(6).tolist(), "cycles": t.mean(axis=0).round(6).tolist()},
           "ratio": (o.mean(axis=0) / t.mean(axis=0)).round(5).tolist()}
    q = np.percentile(block_ratios(ours, theirs, keep), [5, 50, 95])
    out["blocks"] = {"p5": round(q[0], 4), "median": round(q[1], 4), "p95": round(q[2], 4)}
    error = ((o - t) ** 2 / (t ** 2 + eps)).mean(axis=1)
    trimmed = np.sort(error)[:len(error) - max(1, len(error) // 1000)]
    out["relmse"] = {"all": round(error.mean(), 6), "trimmed": round(trimmed.mean(), 6)}
    if second is not None:
        u = second[keep]
        r = (t + u) / 2
        product = ((o - t) * (o - u) / (r ** 2 + eps)).mean(axis=1)
        order = np.argsort(np.abs(product))[:len(product) - max(1, len(product) // 1000)]
        out["relmse"]["less_reference_noise"] = round(product[order].mean(), 6)
        out["reference_noise"] = {"ratio": (u.mean(axis=0) / t.mean(axis=0)).round(5).tolist(),
                                  "blocks": np.percentile(block_ratios(second, theirs, keep), [5, 50, 95]).round(4).tolist()}
    return out


def main():
    a = arguments()
    folder = a.keep or tempfile.mkdtemp(prefix="lucerna-cycles-")
    os.makedirs(folder, exist_ok=True)
    name = os.path.splitext(os.path.basename(a.scene))[0]
    result = {"scene": name, "size": a.size}
    if not a.cycles:
        a.cycles = os.path.join(folder, name + "-cycles.exr")
        result["cycles"] = run_cycles(a, a.cycles, a.seed)
    if a.second == "render":
        a.second = os.path.join(folder, name + "-cycles-2.exr")
        run_cycles(a, a.second, a.seed + 1)
    if not a.lucerna:
        a.lucerna = os.path.join(folder, name + "-lucerna.exr")
        result["lucerna"] = run_lucerna(a, a.lucerna, os.path.join(folder, name + "-lucerna.json"))
    if "cycles" in result and "lucerna" in result:
        result["speed_ratio"] = round(result["lucerna"]["samples_per_s"] / result["cycles"]["samples_per_s"], 3)
    ours, theirs = exr.rgb(a.lucerna), exr.rgb(a.cycles)
    second = exr.rgb(a.second) if a.second else None
    if ours.shape != theirs.shape:
        sys.exit(f"compare.py: {a.lucerna} is {ours.shape[1]}x{ours.shape[0]}, {a.cycles} is "
                 f"{theirs.shape[1]}x{theirs.shape[0]}")
    bad = ~np.isfinite(ours).all(axis=2)
    result["not_finite"] = int(bad.sum())
    keep = ~bad & np.isfinite(theirs).all(axis=2)
    for rectangle in a.leave_out:
        x0, y0, x1, y1 = (int(v) for v in rectangle.split(","))
        keep[y0:y1, x0:x1] = False
    result.update(figures(np.where(keep[:, :, None], ours, 0), theirs, keep, second))
    print(json.dumps(result))


if __name__ == "__main__":
    main()
