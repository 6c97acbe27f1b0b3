# SPDX-License-Identifier: Zlib
# SPDX-FileCopyrightText: 2026 the tetskin authors
"""The materials of the peers, in NumPy: the motion of each of them in sufficiently small steps.

Their energies agree to second order in the strain, with the same Young's modulus and Poisson's ratio, and differ beyond
it. A peer's error is measured against its own material.
"""
import numpy as np

EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]


def cofactor(f):
    """The derivative of the determinant: (n, 3, 3)."""
    a, b, c = f[:, :, 0], f[:, :, 1], f[:, :, 2]
    return np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], 2)


def corotated(f, mu, lam):
    """tetskin's and Rapier's: linear in the strain that remains after removing the rotation."""
    u, _, v = np.linalg.svd(f)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ v))[:, None]
    r = u @ v
    strain = np.swapaxes(r, 1, 2) @ f - np.eye(3)
    strain = 0.5 * (strain + np.swapaxes(strain, 1, 2))
    return r @ (2 * mu * strain + lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3))


def saint_venant_kirchhoff(f, mu, lam):
    """MuJoCo's: linear in Green's strain."""
    strain = 0.5 * (np.swapaxes(f, 1, 2) @ f - np.eye(3))
    return f @ (2 * mu * strain + lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3))


def neo_hookean(f, mu, lam):
    """Newton's: stable neo-Hookean, without a barrier."""
    stress = (lam + mu) * (np.linalg.det(f) - 1 - mu / (lam + mu))
    return mu * f + stress[:, None, None] * cofactor(f)


def bullet_neo_hookean(f, mu, lam):
    """Bullet's: stable neo-Hookean with a logarithm; its own constants are 4/3 mu and lambda + 5/6 mu."""
    mu, lam = 4 / 3 * mu, lam + 5 / 6 * mu
    trace = np.sum(f * f, axis=(1, 2))
    stress = lam * (np.linalg.det(f) - 1) - 0.75 * mu
    return mu * f * (1 - 1 / (trace + 1))[:, None, None] + stress[:, None, None] * cofactor(f)


MATERIALS = {"tetskin": corotated, "rapier": corotated, "mujoco": saint_venant_kirchhoff, "newton": neo_hookean,
             "pybullet": bullet_neo_hookean}


def gradients(nodes, tets):
    """(t, 4, 3): of the linear shape functions."""
    corners = nodes[tets]
    inverse = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
    return np.concatenate([-inverse.sum(1)[:, None], inverse], 1)


def volumes(nodes, tets):
    corners = nodes[tets]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6


def linear_elements(nodes, tets):
    """Nodes of elements (t, 4), gradients at their points (t, points, 4, 3), weights (t, points)."""
    return tets, gradients(nodes, tets)[:, None], volumes(nodes, tets)[:, None]


def quadratic_elements(nodes, tets):
    """Nodes, with those on edges; and elements of ten nodes with four points each, as above."""
    edges = np.sort(tets[:, EDGES].reshape(-1, 2), 1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    all_nodes = np.concatenate([nodes, nodes[unique].mean(1)])
    ten = np.concatenate([tets, len(nodes) + inverse.reshape(-1, 6)], 1)
    g, points = gradients(nodes, tets), np.full((4, 4), 0.1381966011250105) + np.eye(4) * 0.4472135954999579
    corners = (4 * points - 1)[None, :, :, None] * g[:, None]
    middles = [
        4 * (points[None, :, i, None] * g[:, None, j] + points[None, :, j, None] * g[:, None, i]) for i, j in EDGES
    ]
    weights = np.repeat(volumes(nodes, tets)[:, None] / 4, 4, 1)
    return all_nodes, (ten, np.concatenate([corners, np.stack(middles, 2)], 2), weights)


def simulate(nodes, elements, masses, held, material, stress, gravity, dt, steps, each):
    """Leapfrog from rest; each(positions) is called after every step."""
    conn, grad, weights = elements
    mu, lam = material.lame
    flat = grad.reshape(-1, *grad.shape[2:])
    weighted = (grad * weights[:, :, None, None]).reshape(flat.shape)
    ends = np.repeat(conn, grad.shape[1], 0)
    order = np.argsort(ends.ravel(), kind="stable")
    starts = np.searchsorted(ends.ravel()[order], np.arange(len(nodes)))
    x, v = nodes.copy(), np.zeros_like(nodes)
    free = np.where(held, 0.0, 1.0)[:, None]
    for step in range(steps):
        deformed = np.matmul(np.swapaxes(x[ends], 1, 2), flat)
        force = -np.matmul(weighted, np.swapaxes(stress(deformed, mu, lam), 1, 2)).reshape(-1, 3)
        force = np.add.reduceat(force[order], starts, axis=0)
        change = free * (force / masses[:, None] + np.asarray(gravity)) * dt
        v += 0.5 * change if step == 0 else change  # velocities are those at the middle of steps
        x += dt * v
        each(x)
