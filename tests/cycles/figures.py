"""Statistics of two renderers' pictures of one scene, each rendered more than once with different seeds.

Noise is measured, not assumed: the pixels of pictures with different seeds are independent, so the spread between them
gives the variance of every pixel of their average, and its sum over a block that of the block's mean (hundreds of
degrees of freedom).
"""
import numpy as np

BLOCK = 16


class Estimate:
    """The average of several pictures of one renderer with the variance of that average, pixel by pixel."""

    def __init__(self, pictures):
        stack = np.stack(pictures)
        self.count = len(pictures)
        self.mean = stack.mean(axis=0)
        self.variance = stack.var(axis=0, ddof=1) / len(pictures) if len(pictures) > 1 else np.zeros_like(self.mean)


def in_blocks(x, keep, size=BLOCK):
    """Sums over blocks (rows, columns, channels) of the kept pixels; incomplete blocks are dropped."""
    h, w = keep.shape[0] // size, keep.shape[1] // size
    x = np.where(keep[:, :, None], x, 0)[:h * size, :w * size]
    return x.reshape(h, size, w, size, -1).sum(axis=(1, 3))


def block_figures(ours, theirs, keep, tolerance=0.01):
    """Blocks with at least a quarter of their pixels kept, brighter than 1 % of the picture's mean.

    ratio: ours / theirs, mean of the channels; z: the difference over its standard deviation, each channel;
    outside: share of blocks further apart than `tolerance` and four standard deviations in any channel (path tracing's
    tails are heavier than a Gaussian's, so three are exceeded now and then by chance).
    """
    n = in_blocks(np.ones(keep.shape + (1,)), keep)
    o, t = in_blocks(ours.mean, keep), in_blocks(theirs.mean, keep)
    deviation = np.sqrt(in_blocks(ours.variance, keep) + in_blocks(theirs.variance, keep))
    bright = t.mean(axis=2) > 0.01 * theirs.mean[keep].mean() * n[:, :, 0]
    good = bright & (n[:, :, 0] >= BLOCK * BLOCK / 4)
    if not good.any():
        return None
    ratio = o.mean(axis=2)[good] / t.mean(axis=2)[good]
    z = (o - t)[good] / np.maximum(deviation[good], 1e-12)
    relative = (o - t)[good] / np.maximum(t[good], 1e-12)
    outside = ((abs(z) > 4) & (abs(relative) > tolerance)).any(axis=1)
    noise = (deviation[good] / np.maximum(t[good], 1e-12)).mean(axis=1)
    places = np.argwhere(good)
    order = np.argsort(-abs(z).max(axis=1) * outside)
    worst = [{"x": int(places[i][1]) * BLOCK, "y": int(places[i][0]) * BLOCK, "ratio": round(float(ratio[i]), 4),
              "z": z[i].round(1).tolist()} for i in order[:8] if outside[i]]
    q = np.percentile(ratio, [5, 50, 95])
    return {"count": int(good.sum()), "p5": round(q[0], 4), "median": round(q[1], 4), "p95": round(q[2], 4),
            "noise": round(float(np.median(noise)), 4),
            "z_rms": round(float(np.sqrt((z ** 2).mean())), 3),
            "beyond_2_sigma": round(float((abs(z) > 2).mean()), 4),
            "outside": round(float(outside.mean()), 4), "worst": worst}


def around(x):
    """The mean of a pixel's eight neighbours, inside the picture, by channel."""
    h, w = x.shape[:2]
    p, one = np.pad(x, ((1, 1), (1, 1), (0, 0))), np.pad(np.ones((h, w, 1)), ((1, 1), (1, 1), (0, 0)))
    places = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    return sum(p[i:i + h, j:j + w] for i, j in places) / sum(one[i:i + h, j:j + w] for i, j in places)


def relative_mse(picture, first, second, eps=0.01, trimmed=0.001):
    """The mean over pixels and channels of (t - r1)(t - r2) / (r^2 + eps), without the `trimmed` of the pixels whose
    eight neighbours are worst: as in film/io/relative_mse.h, which has the reasons.

    `first` and `second`, r1 and r2, are independent, so that their own noise adds nothing to the mean. r is their mean
    over the pixel's neighbours: were it of the pixel itself, noise would divide by what it has made small or large.
    """
    r = around((first + second) / 2)
    each = ((picture - first) * (picture - second) / (r * r + eps)).mean(axis=2)
    calm = np.argsort(around(each[:, :, None]).ravel(), kind="stable")[:each.size - int(np.ceil(trimmed * each.size))]
    return float(each.ravel()[calm].mean())


def figures(ours, theirs, keep, eps=0.01):
    """Everything compare.py prints of one scene; `ours` and `theirs` are Estimates, `keep` a mask of pixels."""
    o, t = ours.mean[keep], theirs.mean[keep]
    mean_o, mean_t = o.mean(axis=0), t.mean(axis=0)
    deviation = np.sqrt(ours.variance[keep].sum(axis=0) + theirs.variance[keep].sum(axis=0)) / len(o)
    error = ((o - t) ** 2 / (t ** 2 + eps)).mean(axis=1)
    # The difference without both renderers' own noise.
    noise = ((ours.variance[keep] + theirs.variance[keep]) / (t ** 2 + eps)).mean(axis=1)
    calm = np.argsort(error + noise)[:len(error) - max(1, len(error) // 1000)]
    return {"mean": {"lucerna": mean_o.round(6).tolist(), "cycles": mean_t.round(6).tolist()},
            "ratio": (mean_o / mean_t).round(5).tolist(),
            "ratio_sigma": (deviation / mean_t).round(5).tolist(),
            "blocks": block_figures(ours, theirs, keep),
            "relmse": {"all": round(float(error.mean()), 6), "trimmed": round(float(error[calm].mean()), 6),
                       "less_noise": round(float((error - noise)[calm].mean()), 6)}}
