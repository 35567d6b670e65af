"""Meshes changed on purpose: noise, holes, missing parts, other resolutions. A surface is a pair (vertices, faces) of arrays."""
import collections
import heapq
import math

import numpy as np


def surface_of(mesh):
    return mesh.vertices.astype(float), mesh.faces.astype(np.int64)


def with_noise(vertices, faces, share=0.3, seed=1):
    """Normally distributed in every coordinate, with a deviation of a share of the mean edge."""
    mean_edge = np.linalg.norm(vertices[faces] - vertices[np.roll(faces, -1, axis=1)], axis=2).mean()
    return vertices + np.random.default_rng(seed).normal(0, share * mean_edge, vertices.shape), faces


def without(vertices, faces, gone):
    """Lacks the triangles of these vertices; the others keep their numbers."""
    return vertices, faces[~gone[faces].any(axis=1)]


def with_holes(vertices, faces, count=60, seed=1):
    gone = np.random.default_rng(seed).choice(len(vertices), count, replace=False)
    return without(vertices, faces, np.isin(np.arange(len(vertices)), gone))


def resampled(vertices, faces, wanted):
    """About so many vertices: triangles are cut into four until there are enough, and decimated when there are too many."""
    while len(vertices) < 0.9 * wanted:
        edges, number = np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_inverse=True)
        (a, b, c), (ab, bc, ca) = faces.T, len(vertices) + number.reshape(-1, 3).T
        vertices = np.concatenate([vertices, vertices[edges].mean(axis=1)])
        faces = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return decimated(vertices, faces, wanted) if len(vertices) > 1.1 * wanted else (vertices, faces)


def decimated(vertices, faces, wanted):
    """The shortest edges go first: both ends become one in the middle, where they share two neighbours, so that the surface stays one."""
    vertices, faces, around = vertices.copy(), faces.tolist(), collections.defaultdict(set)
    for number, face in enumerate(faces):
        for vertex in face:
            around[vertex].add(number)

    def neighbours(vertex):
        return {corner for number in around[vertex] for corner in faces[number]} - {vertex}

    queue = [(math.dist(vertices[a], vertices[b]), a, b) for face in faces for a, b in zip(face, face[1:] + face[:1])]
    heapq.heapify(queue)
    while queue and len(around) > wanted:
        _, a, b = heapq.heappop(queue)
        if a not in around or b not in around or b not in neighbours(a) or len(neighbours(a) & neighbours(b)) != 2:
            continue
        vertices[b] = (vertices[a] + vertices[b]) / 2
        for number in around.pop(a):
            if b in faces[number]:
                for vertex in set(faces[number]) - {a}:
                    around[vertex].remove(number)
                faces[number] = []
            else:
                faces[number][faces[number].index(a)] = b
                around[b].add(number)
        for vertex in neighbours(b):
            heapq.heappush(queue, (math.dist(vertices[b], vertices[vertex]), b, vertex))
    used, faces = np.unique([face for face in faces if face], return_inverse=True)
    return vertices[used], faces.reshape(-1, 3)
