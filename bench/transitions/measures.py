"""What is measured along paths of conformations, from the coordinates of their CA alone.

Coordinates are arrays in Å: `(atoms, 3)` of a conformation, `(frames, atoms, 3)` of a path. Two conformations are compared by
the root-mean-square distance of all CA after the one superposition that makes it least (W. Kabsch, Acta Cryst. A32, 1976).
"""

import numpy as np

# By how much a virtual bond, from one CA to the next, may be off its lengths in both crystals before the chain counts as torn, Å.
TORN = 0.3

# The domain angles of adenylate kinase (O. Beckstein, E. Denning, J. Perilla, T. Woolf, J. Mol. Biol. 394, 2009): ranges of
# residues, of which the centroids of CA are taken; the angle is the one at the second.
ANGLES = {"NMP": "35-55/90-100/115-125", "LID": "125-153/115-125/179-185"}


def rmsds(path, other):
    """The least RMSD of each frame of `path` and each frame of `other`, an array `(frames, other frames)`."""
    a, b = path - path.mean(axis=1, keepdims=True), other - other.mean(axis=1, keepdims=True)
    size_a, size_b = (a**2).sum(axis=(1, 2)), (b**2).sum(axis=(1, 2))
    flat = np.ascontiguousarray(a.transpose(0, 2, 1)).reshape(-1, a.shape[1])
    found = np.empty((len(a), len(b)))
    for k, frame in enumerate(b):
        covariance = (flat @ frame).reshape(-1, 3, 3)
        singular = np.linalg.svd(covariance, compute_uv=False)
        # A rotation may not mirror: where the best orthogonal matrix does, the smallest singular value counts negative.
        singular[:, 2] *= np.sign(np.linalg.det(covariance))
        squares = size_a + size_b[k] - 2 * singular.sum(axis=1)
        found[:, k] = np.sqrt(np.maximum(squares, 0) / a.shape[1])
    return found


def steps(path):
    """The RMSD of each frame and the next, `frames - 1` numbers."""
    return np.array([rmsds(path[k : k + 1], path[k + 1 : k + 2])[0, 0] for k in range(len(path) - 1)])


def shares(path):
    """How far along its length each frame of a path is, from 0 to 1."""
    along = np.concatenate([[0.0], np.cumsum(steps(path))])
    return along / along[-1]


def virtual_bonds(path):
    """The distances of successive CA, `(frames, atoms - 1)`."""
    return np.linalg.norm(np.diff(path, axis=1), axis=2)


def off_bonds(path, ends):
    """By how much the worst virtual bond of each frame is off its length in both `ends`, Å: off the nearer of the two lengths."""
    off = [np.abs(virtual_bonds(path) - virtual_bonds(end[None])) for end in ends]
    return np.min(off, axis=0).max(axis=1)


def angle(path, ranges, numbers):
    """A domain angle in every frame, degrees. `numbers` are those of the residues, one for each CA."""
    centroids = []
    for text in ranges.split("/"):
        first, last = (int(number) for number in text.split("-"))
        centroids.append(path[:, (numbers >= first) & (numbers <= last)].mean(axis=1))
    u, v = centroids[0] - centroids[1], centroids[2] - centroids[1]
    cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
    return np.degrees(np.arccos(cosine))


def midway(along, share):
    """The smallest share of a path's length at which a quantity has come to the middle between its values at the two ends.

    `along` has its value in every frame, `share` how far along each frame is; between two frames it is taken to be linear.
    """
    middle = (along[0] + along[-1]) / 2
    beyond = (along - middle) * np.sign(along[-1] - along[0])
    k = int(np.argmax(beyond >= 0))
    part = -beyond[k - 1] / (beyond[k] - beyond[k - 1])
    return float(share[k - 1] + part * (share[k] - share[k - 1]))


def hausdorff(distances):
    """The Hausdorff distance of two paths, of the RMSD of each two frames: how far any frame of either is from the other path."""
    return max(distances.min(axis=1).max(), distances.min(axis=0).max())


def frechet(distances):
    """The discrete Fréchet distance (T. Eiter, H. Mannila, 1994): both paths walked along, the longest leash that is needed."""
    rows, columns = distances.shape
    leash = np.empty((rows, columns))
    leash[0] = np.maximum.accumulate(distances[0])
    for i in range(1, rows):
        leash[i, 0] = max(leash[i - 1, 0], distances[i, 0])
        for j in range(1, columns):
            before = min(leash[i - 1, j - 1], leash[i - 1, j], leash[i, j - 1])
            leash[i, j] = max(before, distances[i, j])
    return leash[-1, -1]
