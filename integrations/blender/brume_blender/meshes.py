"""Mesh normals and transforms, for Blender versions before and after 4.1."""

import numpy as np


def cofactors(m):
    """|det(m)| times the inverse transpose of m: transforms normals up to their length."""
    rows = np.array([np.cross(m[1], m[2]), np.cross(m[2], m[0]), np.cross(m[0], m[1])])
    return rows * (np.sign(np.linalg.det(m)) or 1.0)


def corner_normals(mesh):
    normals = np.empty(3 * len(mesh.loops), dtype=np.float32)
    if hasattr(mesh, "calc_normals_split"):  # Until Blender 4.0.
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals)
    else:
        mesh.corner_normals.foreach_get("vector", normals)
    return normals.reshape(-1, 3)


def bend(mesh, matrix):
    """Applies a matrix without reflection to a mesh; transforms the corner normals with it."""
    linear = np.array(matrix)[:3, :3]
    normals = corner_normals(mesh).astype(float) @ cofactors(linear).T
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    mesh.transform(matrix)
    if hasattr(mesh, "use_auto_smooth"):  # Until Blender 4.0: required by custom normals.
        mesh.use_auto_smooth = True
    mesh.normals_split_custom_set(normals.tolist())
