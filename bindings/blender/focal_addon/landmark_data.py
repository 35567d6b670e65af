"""The landmarks of an object: reading and writing the collection that is stored with it."""
from .geometry import Surface

# A place further than this share of the mesh's size from where it was put no longer belongs to the mesh as it is.
_MOVED = 1e-3


def active_of(obj):
    """The landmark that the list shows as active, or None."""
    if obj is None or obj.type != "MESH":
        return None
    marks = obj.focal.landmarks
    return marks[obj.focal.active] if 0 <= obj.focal.active < len(marks) else None


def index_of(obj, name):
    return obj.focal.landmarks.find(name)


def ensure(obj, name):
    """The landmark of this name, made if it is not there."""
    at = index_of(obj, name)
    if at >= 0:
        return obj.focal.landmarks[at]
    mark = obj.focal.landmarks.add()
    mark.name = name
    return mark


def forget(obj, name):
    """Takes a landmark off the list that another object of the character has now."""
    at = index_of(obj, name)
    if at >= 0 and not obj.focal.landmarks[at].by_hand:
        obj.focal.landmarks.remove(at)


def place(obj, mark, surface, triangle, barycentric, status="MARKED"):
    """Puts a landmark onto the surface."""
    mark.triangle = triangle
    mark.barycentric = barycentric
    mark.position = surface.at(triangle, barycentric)
    mark.status = status
    if status == "MARKED":
        mark.confidence = 1.0
        mark.expected_error = 0.0
    obj.focal.triangle_count = len(surface.triangles)


def place_near(obj, mark, surface, position, status="MARKED"):
    """Puts a landmark onto the point of the surface nearest to a local position; its distance from there."""
    triangle, barycentric, distance = _nearest(surface, position)
    place(obj, mark, surface, triangle, barycentric, status)
    return distance


def _nearest(surface, position):
    """(triangle, barycentric, distance) of the place of the surface nearest to a local position."""
    location, triangle, distance = surface.nearest(position)
    return triangle, surface.barycentric(triangle, location), distance


def unplace(mark, status="UNPLACED", by_hand=False):
    mark.triangle = -1
    mark.status = status
    mark.told_absent = by_hand and status == "ABSENT"
    mark.confidence = 0.0
    mark.runner_up_triangle = -1


def stale(surface, mark):
    """Whether the mesh was changed below the landmark since it was placed."""
    if mark.triangle >= len(surface.triangles):
        return True
    return (surface.at(mark.triangle, mark.barycentric) - mark.position).length > _MOVED * surface.size()


def snap_stale(obj, surface):
    """Takes landmarks along after the mesh was edited: the nearest place of the new surface. How many moved."""
    moved = 0
    for mark in obj.focal.landmarks:
        if mark.placed and stale(surface, mark):
            place_near(obj, mark, surface, mark.position, mark.status)
            moved += 1
    return moved


def next_unplaced(obj, after=-1):
    """Number of the first landmark past `after` that has no place and is not known to be absent; -1: all have."""
    marks = obj.focal.landmarks
    for step in range(1, len(marks) + 1):
        at = (after + step) % len(marks)
        if marks[at].status == "UNPLACED":
            return at
    return -1


def counts(obj):
    """(placed, of how many, uncertain)"""
    marks = obj.focal.landmarks
    return (sum(m.placed for m in marks), len(marks), sum(m.status == "UNCERTAIN" for m in marks))


def surface_with_marks(obj):
    """The object's surface, and its landmarks on it, as {name: (triangle, barycentric)} in focal's order of corners."""
    surface = Surface(obj)
    snap_stale(obj, surface)
    return surface, {m.name: (m.triangle, surface.turned(m.barycentric)) for m in obj.focal.landmarks if m.placed}


def fixed_places(obj, surface):
    """Landmarks set by hand, as {name: (triangle, barycentric)} in focal's order of corners. Where the mesh was edited
    below one, the nearest place; the landmark itself stays as it is."""
    fixed = {}
    for mark in obj.focal.landmarks:
        if not (mark.placed and mark.by_hand):
            continue
        triangle, barycentric = mark.triangle, mark.barycentric
        if stale(surface, mark):
            triangle, barycentric, _distance = _nearest(surface, mark.position)
        fixed[mark.name] = triangle, surface.turned(barycentric)
    return fixed
