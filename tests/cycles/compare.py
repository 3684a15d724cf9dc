#!/usr/bin/python3
"""Compares Lucerna with Blender's Cycles: renders scenes with both, compares pictures or speed, prints a table.

  tests/cycles/compare.py scenes/cornell/cornell.gltf --size 128x128 --samples 1024
  tests/cycles/compare.py scenes/cornell/cornell.gltf scenes/atrium/atrium.gltf --speed --size 480x270 --samples 32

Needs Debian's `blender` (3.4) and `python3-numpy`. Not part of ./test: it takes minutes and a peer that may be absent.
Everything it writes goes to a temporary folder, or where --keep and --json say.

Pictures: each renderer makes one picture a seed (--seeds), from whose spread the noise is known. A scene agrees when
  - the means of every channel are within 1 % (`ratio`, with its standard deviation), and
  - no 16x16 block is further off than 1 % and four standard deviations (`outside`), and the root mean square of the
    blocks' z-scores stays below 1.3 (1: nothing but noise).
--leave-out X0,Y0,X1,Y1 leaves pixels out (parts of the picture's width and height, 0 to 1, origin at the top left).
Nothing has to be left out beside the Cornell box's lamp: blender_scene.py cuts emitters into small triangles, which
Cycles 3.4 samples by area; the solid angles of large near ones it samples wrongly (3-7 % too dark).
What Cycles cannot do as Lucerna does is in blender_materials.py; --without FEATURE,... renders reduced copies of the
scene with both (reduce.py), e.g. --without normals.

Speed: samples/s of the rendering alone (pixels x samples / seconds), scene loaded, kernels and acceleration structure
built, --threads for both; medians of --repeats runs, the two renderers taking turns. The same per second of processor
time stays comparable on a machine that does other work meanwhile (start-up subtracted).
"""
import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from statistics import median

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import exr  # noqa: E402
from figures import Estimate  # noqa: E402
from figures import figures  # noqa: E402
from reduce import FEATURES  # noqa: E402
from reduce import reduced  # noqa: E402


def common_arguments(p):
    """Arguments of every script that renders with both."""
    p.add_argument("--camera", default="")
    p.add_argument("--depth", type=int, default=64)
    p.add_argument("--threads", type=int, default=2)
    p.add_argument("--program", default=os.path.join(HERE, "..", "..", "build", "release", "bin", "lucerna"))
    p.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="passed on to Lucerna")
    p.add_argument("--repeats", type=int, default=3)
    p.add_argument("--keep", metavar="DIR", help="where the pictures go; those already there are used again")
    p.add_argument("--json", metavar="FILE", help="write all figures there")


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("scenes", nargs="+", metavar="SCENE")
    p.add_argument("--size", default="auto", help="WxH; auto: 160 wide with the camera's aspect (or 16:9)")
    p.add_argument("--samples", type=int, default=256, help="of each picture of Lucerna, and of Cycles unless ...")
    p.add_argument("--cycles-samples", type=int)
    p.add_argument("--seeds", type=int, default=2, help="pictures of each renderer")
    p.add_argument("--leave-out", action="append", default=[], metavar="X0,Y0,X1,Y1")
    p.add_argument("--without", default="", metavar="FEATURE,...",
                   help="render a reduced copy, to find what differs: " + ", ".join(FEATURES))
    p.add_argument("--speed", action="store_true")
    common_arguments(p)
    return p.parse_args()


def camera_aspect(path, name):
    """Width over height of the scene's camera, default 16/9."""
    data = open(path, "rb").read()
    if data[:4] == b"glTF":
        data = data[20:20 + int.from_bytes(data[12:16], "little")]
    doc = json.loads(data)
    cameras = doc.get("cameras", [])
    named = [c for c in cameras if name and c.get("name") == name] or cameras
    return named[0].get("perspective", {}).get("aspectRatio", 16 / 9) if named else 16 / 9


class Job:
    """One scene, rendered by either program. `a`: size and common_arguments()."""

    def __init__(self, a, scene, folder, without=""):
        self.a, self.scene, self.folder = a, scene, folder
        self.name = os.path.splitext(os.path.basename(scene))[0]
        if without:
            self.folder = os.path.join(folder, self.name + "-without-" + without.replace(",", "-"))
            os.makedirs(self.folder, exist_ok=True)
            self.scene = reduced(scene, without.split(","), self.folder)
        if a.size == "auto":
            aspect = camera_aspect(scene, a.camera)
            w, h = (160, round(160 / aspect)) if aspect >= 1 else (round(160 * aspect), 160)
            self.size = f"{w}x{h}"
        else:
            self.size = a.size
        self.width, self.height = (int(v) for v in self.size.split("x"))

    def path(self, renderer, samples, seed):
        camera = "-" + self.a.camera if self.a.camera else ""
        return os.path.join(self.folder, f"{self.name}{camera}-{self.size}-{renderer}-{samples}-{seed}.exr")

    def lucerna(self, seed, samples, settings=()):
        """Renders one picture; its samples/s. `settings`: KEY=VALUE, beside those that both take."""
        out, stats = self.path("lucerna", samples, seed), os.path.join(self.folder, self.name + "-stats.json")
        command = [self.a.program, "render", self.scene, "-o", out, "--size", self.size, "--samples",
                   str(samples), "--seed", str(seed), "--stats", stats, "--quiet",
                   "--set", f"path.max_depth={self.a.depth}"]
        if self.a.camera:
            command += ["--camera", self.a.camera]
        for s in settings:
            command += ["--set", s]
        # Lavapipe and Embree's pool both follow the affinity; lavapipe also reads a variable.
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, env={**os.environ, "LP_NUM_THREADS": str(self.a.threads)}, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            sys.exit(done.stdout[-3000:] + "\ncompare.py: Lucerna did not render")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        found = json.load(open(stats))
        stages = {s["name"]: round(s["ms"]) for s in found.get("stages", [])}
        return {"samples_per_s": self.width * self.height * samples / found["wall_s"],
                "render_s": found["wall_s"],
                "cpu_s": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, "tracer": found.get("tracer"), "device": found.get("device"),
                "stages_ms": stages}

    def cycles(self, seeds, samples):
        """Renders one picture per seed in one session of Blender; samples/s of the first."""
        command = ["blender", "-b", "--factory-startup", "-P", os.path.join(HERE, "blender_scene.py"), "--", self.scene,
                   self.path("cycles", samples, "SEED"), "--size", self.size, "--samples", str(samples), "--depth",
                   str(self.a.depth), "--seeds", ",".join(str(s) for s in seeds), "--threads", str(self.a.threads)]
        if self.a.camera:
            command += ["--camera", self.a.camera]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in done.stdout.splitlines():
            if line.startswith("CYCLES "):
                return json.loads(line[7:])
        sys.exit(done.stdout[-3000:] + "\ncompare.py: Blender did not render")


def compare(job):
    a, seeds = job.a, range(job.a.seeds)
    for seed in seeds:
        if not os.path.exists(job.path("lucerna", a.samples, seed)):
            job.lucerna(seed, a.samples, a.set)
    samples = a.cycles_samples or a.samples
    missing = [s for s in seeds if not os.path.exists(job.path("cycles", samples, s))]
    if missing:
        job.cycles(missing, samples)
    ours = [exr.rgb(job.path("lucerna", a.samples, s)) for s in seeds]
    theirs = [exr.rgb(job.path("cycles", samples, s)) for s in seeds]
    finite = np.isfinite(np.stack(ours)).all(axis=(0, 3))
    keep = finite & np.isfinite(np.stack(theirs)).all(axis=(0, 3))
    for rectangle in a.leave_out:
        x0, y0, x1, y1 = (float(v) for v in rectangle.split(","))
        keep[round(y0 * job.height):round(y1 * job.height), round(x0 * job.width):round(x1 * job.width)] = False
    clean = [[np.where(keep[:, :, None], p, 0) for p in pictures] for pictures in (ours, theirs)]
    result = {"scene": job.name, "size": job.size, "samples": [a.samples * a.seeds, samples * a.seeds],
              "left_out": a.leave_out, "without": a.without, "not_finite": int((~finite).sum())}
    result.update(figures(Estimate(clean[0]), Estimate(clean[1]), keep))
    b = result["blocks"]
    result["agrees"] = bool(result["not_finite"] == 0 and max(abs(r - 1) for r in result["ratio"]) <= 0.01 and
                            b is not None and b["outside"] == 0 and b["z_rms"] < 1.3)
    return result


def print_pictures(results):
    print(f"{'scene':16} {'size':>8} {'spp':>9}  {'mean of Lucerna':23} {'mean of Cycles':23} {'ratio R, G, B (sd)':29} "
          f"{'blocks 5/50/95 %':22} {'z rms':>6} {'outside':>8}  agrees")
    for r in results:
        three = [" ".join(f"{v:7.4f}" for v in r["mean"][k]) for k in ("lucerna", "cycles")]
        ratio = " ".join(f"{v:.4f}" for v in r["ratio"]) + f" ({max(r['ratio_sigma']):.4f})"
        b = r["blocks"] or {"p5": 0, "median": 0, "p95": 0, "z_rms": 0, "outside": 1}
        print(f"{r['scene']:16} {r['size']:>8} {r['samples'][0]:>9}  {three[0]} {three[1]} {ratio:29} "
              f"{b['p5']:.4f} {b['median']:.4f} {b['p95']:.4f}   {b['z_rms']:6.2f} {100 * b['outside']:6.1f} %  "
              f"{'yes' if r['agrees'] else 'NO'}")


def speed(job):
    ours, theirs = [], []
    a = job.a
    job.lucerna(0, 1, a.set)   # kernels compiled and cached, files read once
    start = job.lucerna(0, 1, a.set)["cpu_s"]
    for i in range(a.repeats):
        ours.append(job.lucerna(i, a.samples, a.set))
        ours[-1]["cpu_s"] = max(ours[-1]["cpu_s"] - start, 1e-3)
        theirs.append(job.cycles([i], a.cycles_samples or a.samples))
    work = job.width * job.height * job.a.samples
    result = {"scene": job.name, "size": job.size, "samples": job.a.samples, "threads": job.a.threads}
    for name, runs in (("lucerna", ours), ("cycles", theirs)):
        result[name] = {"samples_per_s": median([r["samples_per_s"] for r in runs]),
                        "samples_per_cpu_s": median([work / r["cpu_s"] for r in runs]),
                        "all": [round(r["samples_per_s"]) for r in runs]}
    result["stages_ms"] = ours[-1]["stages_ms"]
    for key in ("samples_per_s", "samples_per_cpu_s"):
        result[key.replace("samples", "ratio")] = round(result["lucerna"][key] / result["cycles"][key], 3)
    return result


def print_speed(results):
    print(f"{'scene':16} {'size':>8} {'spp':>5}  {'samples/s: Lucerna':>18} {'Cycles':>10} {'ratio':>6}   "
          f"{'a CPU second: Lucerna':>21} {'Cycles':>9} {'ratio':>6}   stages of Lucerna "
          f"({results[0]['threads']} threads, medians of {len(results[0]['lucerna']['all'])})")
    for r in results:
        a, b, stages = r["lucerna"], r["cycles"], r["stages_ms"]
        total = sum(stages.values()) or 1
        print(f"{r['scene']:16} {r['size']:>8} {r['samples']:>5}  {a['samples_per_s']:18,.0f} "
              f"{b['samples_per_s']:10,.0f} {r['ratio_per_s']:6.3f}   {a['samples_per_cpu_s']:21,.0f} "
              f"{b['samples_per_cpu_s']:9,.0f} {r['ratio_per_cpu_s']:6.3f}   "
              + ", ".join(f"{k} {100 * v / total:.0f} %" for k, v in stages.items() if v > 0.005 * total))


def main():
    a = arguments()
    folder = a.keep or tempfile.mkdtemp(prefix="lucerna-cycles-")
    os.makedirs(folder, exist_ok=True)
    results = []
    for scene in a.scenes:
        job = Job(a, scene, folder, a.without)
        results.append(speed(job) if a.speed else compare(job))
        print(f"{job.name} done", file=sys.stderr, flush=True)
    (print_speed if a.speed else print_pictures)(results)
    if a.json:
        with open(a.json, "w") as f:
            json.dump(results, f, indent=1)
    return 0 if a.speed or all(r["agrees"] for r in results) else 1


if __name__ == "__main__":
    sys.exit(main())
