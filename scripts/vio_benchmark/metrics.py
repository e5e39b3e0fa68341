"""Errors of a trajectory against the truth: absolute after alignment (Umeyama 1991), and relative over a stretch of time."""
import numpy


def align(estimate, truth, with_scale):
    """Scale, rotation and translation with the least squared distance of scale * R * estimate + t from truth. Both: n x 3."""
    mean_estimate, mean_truth = estimate.mean(axis=0), truth.mean(axis=0)
    centred = estimate - mean_estimate
    covariance = (truth - mean_truth).T @ centred / len(estimate)
    u, singular_values, v = numpy.linalg.svd(covariance)
    # A reflection fits better where all points lie in a plane.
    signs = numpy.array([1.0, 1.0, numpy.sign(numpy.linalg.det(u @ v)) or 1.0])
    rotation = u @ numpy.diag(signs) @ v
    variance = (centred ** 2).sum() / len(estimate)
    scale = float((singular_values * signs).sum() / variance) if with_scale and variance > 0.0 else 1.0
    return scale, rotation, mean_truth - scale * rotation @ mean_estimate


def absolute_error(estimate, truth, with_scale=False):
    """Root of the mean squared distance after alignment: SE(3), or Sim(3) with the scale [m]."""
    scale, rotation, translation = align(estimate, truth, with_scale)
    return float(numpy.sqrt((((scale * estimate @ rotation.T + translation) - truth) ** 2).sum(axis=1).mean()))


def angle(rotation):
    """Of a rotation matrix [rad]. By the sine as well: the arc cosine alone knows nothing of small angles."""
    skew = numpy.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    return float(numpy.arctan2(numpy.linalg.norm(skew), numpy.trace(rotation) - 1.0))


def relative_errors(stamps, estimate, truth, seconds):
    """Of the movements over `seconds`: root mean square in position [m] and angle [rad]; NaN where no pair is so far apart.

    estimate, truth: 4 x 4 poses, world from body, at the stamps [s], which rise. No alignment is needed.
    """
    stamps = numpy.asarray(stamps)
    distances, angles = [], []
    for i, stamp in enumerate(stamps):
        k = int(numpy.searchsorted(stamps, stamp + seconds - 1e-3))
        # A gap is no movement over that time.
        if k >= len(stamps) or stamps[k] > stamp + 1.1 * seconds:
            continue
        moved = numpy.linalg.inv(estimate[i]) @ estimate[k]
        moved_truly = numpy.linalg.inv(truth[i]) @ truth[k]
        error = numpy.linalg.inv(moved_truly) @ moved
        distances.append(numpy.linalg.norm(error[:3, 3]))
        angles.append(angle(error[:3, :3]))
    if not distances:
        return float('nan'), float('nan')
    return float(numpy.sqrt(numpy.mean(numpy.square(distances)))), float(numpy.sqrt(numpy.mean(numpy.square(angles))))


def rotation_matrix(x, y, z, w):
    """Of a quaternion, which need not have length 1."""
    x, y, z, w = numpy.array([x, y, z, w]) / numpy.sqrt(x * x + y * y + z * z + w * w)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def quaternion(rotation):
    """x, y, z, w of a rotation matrix; w is not negative."""
    turn = angle(rotation)
    _, vectors = numpy.linalg.eigh(rotation + rotation.T)
    axis = vectors[:, -1]  # of the largest eigenvalue; its sign is open
    skew = numpy.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    axis = axis if axis @ skew >= 0.0 else -axis
    return (*(numpy.sin(turn / 2.0) * axis), float(numpy.cos(turn / 2.0)))


def pose_matrix(position, quaternion):
    """4 x 4 from anything with x, y, z and with x, y, z, w."""
    pose = numpy.eye(4)
    pose[:3, :3] = rotation_matrix(quaternion.x, quaternion.y, quaternion.z, quaternion.w)
    pose[:3, 3] = position.x, position.y, position.z
    return pose


def slerp(a, b, share):
    """Between two rotation matrices, by the axis of the rotation from a to b."""
    difference = a.T @ b
    turn = angle(difference)
    if turn < 1e-9:
        return a
    axis = numpy.array([difference[2, 1] - difference[1, 2], difference[0, 2] - difference[2, 0],
                        difference[1, 0] - difference[0, 1]]) / (2.0 * numpy.sin(turn))
    k = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    part = share * turn
    return a @ (numpy.eye(3) + numpy.sin(part) * k + (1.0 - numpy.cos(part)) * k @ k)


def pose_at(stamps, poses, stamp, max_gap=0.2):
    """Interpolated between neighbours; None outside, or in a gap of over `max_gap` seconds."""
    k = int(numpy.searchsorted(stamps, stamp))
    if k < len(stamps) and abs(stamps[k] - stamp) < 1e-6:
        return poses[k]
    if k == 0 or k == len(stamps) or stamps[k] - stamps[k - 1] > max_gap:
        return None
    share = (stamp - stamps[k - 1]) / (stamps[k] - stamps[k - 1])
    pose = numpy.eye(4)
    pose[:3, :3] = slerp(poses[k - 1][:3, :3], poses[k][:3, :3], share)
    pose[:3, 3] = (1.0 - share) * poses[k - 1][:3, 3] + share * poses[k][:3, 3]
    return pose
