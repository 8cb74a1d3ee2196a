"""Converts Blender's axes and units to Brume's: Z up to Y up, scene units to metres. Matrices are float64 arrays."""

import math

import numpy as np

from .messages import BrumeError

# Maps (x, y, z) of Blender to (x, z, -y) of Brume: a rotation by -90 degrees about x; both are right-handed.
BRUME_FROM_BLENDER = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])

_TINY = 1e-6


def metres_per_unit(scene):
    """The length of a Blender unit [m]; Blender ignores the unit scale if the unit system is None."""
    settings = scene.unit_settings
    return settings.scale_length if settings.system != "NONE" else 1.0


def point(blender_point, metres):
    """Converts a world-space point to Brume [m]."""
    return BRUME_FROM_BLENDER @ np.array(blender_point, dtype=float)[:3] * metres


def matrix(blender_matrix, metres):
    """world_from_mesh in Brume's axes and metres, for mesh points rotated by BRUME_FROM_BLENDER."""
    source = np.array(blender_matrix, dtype=float)
    result = np.identity(4)
    result[:3, :3] = BRUME_FROM_BLENDER @ source[:3, :3] @ BRUME_FROM_BLENDER.T * metres
    result[:3, 3] = point(source[:3, 3], metres)
    return result


def from_file(blender_matrix, metres):
    """world_from_file in Brume's axes and metres, for points of a volume file in Blender's axes and units."""
    turn = np.identity(4)
    turn[:3, :3] = BRUME_FROM_BLENDER * metres
    return turn @ np.array(blender_matrix, dtype=float)


def has_orthogonal_columns(linear):
    """Whether a 3x3 matrix is a rotation or reflection times a nonzero scale along the mesh axes."""
    lengths = np.linalg.norm(linear, axis=0)
    if lengths.min() <= _TINY * lengths.max():
        return False
    unit = linear / lengths
    return np.abs(unit.T @ unit - np.identity(3)).max() <= _TINY


def scale_and_angles(linear):
    """The scale and the angles of a Scene.txt line, or None if they cannot represent the matrix.

    Scene.txt scales after it rotates: linear = diag(scale) * Rx(-x) * Ry(-y) * Rz(-z). That requires orthogonal
    rows, which a rotated object has only with a uniform scale.
    """
    if not has_orthogonal_columns(linear.T):
        return None
    scale = np.linalg.norm(linear, axis=1)
    if np.linalg.det(linear) < 0:
        scale = -scale
    turn = linear / scale[:, None]
    across = math.hypot(turn[0, 0], turn[0, 1])
    y = math.atan2(turn[0, 2], across)
    if across > 1e-7:
        x, z = math.atan2(-turn[1, 2], turn[2, 2]), math.atan2(-turn[0, 1], turn[0, 0])
    else:  # Gimbal lock at 90 degrees about y: x and z rotate about the same axis.
        x, z = math.atan2(turn[2, 1], turn[1, 1]), 0.0
    return scale, -np.array([x, y, z])


def number(value):
    """Formats a number with the fewest digits that give the same float32, as a TOML float."""
    rounded = np.float32(value) + np.float32(0)  # -0 becomes 0.
    if not np.isfinite(rounded):
        raise BrumeError("a position or setting of the scene is not finite; check the transforms")
    return np.format_float_positional(rounded, unique=True, trim="0")


def radius_of_voxels(count, voxel):
    """The radius of a ball of `count` voxels with an edge of `voxel`."""
    return voxel * (count * 0.75 / math.pi) ** (1 / 3)


def voxels_of_radius(radius, voxel):
    """The number of voxels, at least 1, whose volume is that of a ball."""
    return max(1, round((radius / voxel) ** 3 * math.pi / 0.75))
