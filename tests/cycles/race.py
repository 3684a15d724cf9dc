#!/usr/bin/python3
"""How long Lucerna and Blender's Cycles take to the same error of the whole picture, one after the other.

  tests/cycles/race.py scenes/cornell/cornell.gltf --error 0.002 --set components.secondary=cache --set components.tertiary=cache
  tests/cycles/race.py scenes/window/window.gltf --error 0.01 --size 256x256 --reference-samples 16384 --set components.primary=cache

Error: relative_mse() of figures.py, with epsilon 0.01 and without the worst 0.1 % of the pixels, against two independent
long pictures. Each renderer is compared with its own ones (Lucerna's by path tracing, without --set). By how much they
miss each other's, and the ratio of their means, is printed.

The samples that reach the error are found first, by pilots; then both render with those, --repeats times in turns. Time
is that of the rendering: Lucerna's with building the cache, without loading the scene; Cycles' without copying the scene and
building its acceleration structure. Kernels are compiled before.
"""
import argparse
import json
import math
import os
import sys
import tempfile
from statistics import median

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import exr  # noqa: E402
from compare import Job  # noqa: E402
from compare import common_arguments  # noqa: E402
from figures import relative_mse  # noqa: E402


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("scene", metavar="SCENE")
    p.add_argument("--error", type=float, required=True, help="relative mean squared error to reach")
    p.add_argument("--size", default="256x256", help="WxH")
    p.add_argument("--samples", type=int, default=32, help="of the first pilots")
    p.add_argument("--most-samples", type=int, default=16384, help="no more than these are tried")
    p.add_argument("--reference-samples", type=int, default=4096, help="of each of two pictures by either renderer")
    common_arguments(p)
    return p.parse_args()


class Racer:
    """A renderer: its references, and pictures with a given number of samples."""

    def __init__(self, job, name):
        self.job, self.name, self.references = job, name, []

    def render(self, samples, seeds, settings=()):
        """Renders a picture per seed; returns the render time of the first [s]."""
        if self.name == "cycles":
            return self.job.cycles(seeds, samples)["render_s"]
        return [self.job.lucerna(seed, samples, settings)["render_s"] for seed in seeds][0]

    def run(self, samples, seed):
        """The error of a picture, and its render time [s]."""
        seconds = self.render(samples, [seed], self.job.a.set)
        return relative_mse(exr.rgb(self.job.path(self.name, samples, seed)), *self.references), seconds

    def make_references(self):
        samples = self.job.a.reference_samples
        paths = {seed: self.job.path(self.name, samples, seed) for seed in (1001, 1002)}
        missing = [seed for seed, path in paths.items() if not os.path.exists(path)]
        if missing:
            self.render(samples, missing)
        self.references = [exr.rgb(path) for path in paths.values()]

    def samples_for(self, error):
        """Samples that reach the error, with the pilots as (samples, error, seconds)."""
        samples, pilots = self.job.a.samples, []
        for _ in range(8):
            found, seconds = self.run(samples, 1)
            pilots.append((samples, found, seconds))
            print(f"  {self.name}: {samples} samples, error {found:.6f}, {seconds:.2f} s", file=sys.stderr, flush=True)
            # Scales with 1 / samples. An error that more samples do not reduce (a cache's) would need more and more.
            if 0.9 * error < found <= error or (found <= error and samples == 1):
                break
            more = max(1, math.ceil(samples * found / error * 1.02))
            if more > self.job.a.most_samples or more in [p[0] for p in pilots]:
                break
            samples = more
        reached = [p[0] for p in pilots if p[1] <= error]
        return (min(reached) if reached else None), pilots


def main():
    a = arguments()
    folder = a.keep or tempfile.mkdtemp(prefix="lucerna-cycles-")
    os.makedirs(folder, exist_ok=True)
    job = Job(a, a.scene, folder)
    racers = [Racer(job, "lucerna"), Racer(job, "cycles")]
    job.lucerna(0, 1, a.set)  # kernels compiled and cached, files read once
    result = {"scene": job.name, "size": job.size, "error": a.error, "set": a.set, "threads": a.threads}
    for r in racers:
        r.make_references()
        print(f"  {r.name}: references there", file=sys.stderr, flush=True)
    for r, other in zip(racers, reversed(racers)):
        samples, pilots = r.samples_for(a.error)
        result[r.name] = {"samples": samples, "pilots": pilots, "runs": [],
                          "reference_against_other": relative_mse(r.references[0], *other.references),
                          "reference_mean": r.references[0].mean(axis=(0, 1)).round(6).tolist()}
    if all(result[r.name]["samples"] for r in racers):
        for i in range(a.repeats):
            for r in racers:
                result[r.name]["runs"].append(r.run(result[r.name]["samples"], 100 + i))
        for r in racers:
            result[r.name]["seconds"] = median(s for _, s in result[r.name]["runs"])
            result[r.name]["error"] = median(e for e, _ in result[r.name]["runs"])
        result["ratio"] = result["cycles"]["seconds"] / result["lucerna"]["seconds"]
    means = [result[r.name]["reference_mean"] for r in racers]
    print(f"{job.name} {job.size} references: Lucerna's mean over Cycles' "
          + " ".join(f"{ours / theirs:.4f}" for ours, theirs in zip(*means) if theirs > 0))
    for r in racers:
        f = result[r.name]
        if "seconds" in f:
            print(f"{job.name} {job.size} {r.name:8} error {f['error']:.6f} with {f['samples']} samples in {f['seconds']:.2f} s "
                  f"({', '.join(f'{s:.2f}' for _, s in f['runs'])}); its reference against the other's {f['reference_against_other']:.6f}")
        else:
            last = f["pilots"][-1]
            print(f"{job.name} {job.size} {r.name:8} "
                  + (f"reaches {a.error} with {f['samples']} samples" if f["samples"] else
                     f"does NOT reach {a.error}: {last[1]:.6f} with {last[0]} samples in {last[2]:.2f} s"))
    if "ratio" in result:
        print(f"{job.name}: Lucerna is there {result['ratio']:.2f} times as fast")
    if a.json:
        with open(a.json, "w") as f:
            json.dump(result, f, indent=1)
    return 0 if "ratio" in result else 1


if __name__ == "__main__":
    sys.exit(main())
