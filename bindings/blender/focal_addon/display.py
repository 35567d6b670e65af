"""How landmarks show in the scene: empties, colours of confidence, and vote maps as a colour attribute."""
import bpy
import numpy
from mathutils import Vector

VOTES = "focal votes"
PARTS = "focal parts"
_EMPTY_SHARE = 0.012  # of the mesh's size
_STATUS_SHAPE = {"MARKED": "CUBE", "FOUND": "SPHERE", "UNCERTAIN": "CONE"}


def colour_of(mark):
    """Blue: by hand. Else from red (a guess) over yellow to green (sure). Linear, with alpha."""
    if mark.status == "MARKED":
        return (0.10, 0.45, 1.0, 1.0)
    sure = min(1.0, max(0.0, mark.confidence))
    return (min(1.0, 2 - 2 * sure), min(0.85, 1.7 * sure), 0.05, 1.0)


def refresh(context, obj):
    """After landmarks changed: the empties follow where there are any, the view is drawn again."""
    if empties_of(obj):
        update_empties(context, obj)
    redraw(context)


def redraw(context):
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D":
            area.tag_redraw()


def empties_of(obj):
    """{landmark name: empty}; names of objects may get numbers, so the landmark's is kept as a property."""
    return {child["focal_landmark"]: child for child in obj.children
            if child.type == "EMPTY" and "focal_landmark" in child}


def empty_place(obj, name):
    """Where the landmark's empty stands, locally; None without one."""
    empty = empties_of(obj).get(name)
    return None if empty is None else obj.matrix_world.inverted() @ empty.matrix_world.translation


def update_empties(context, obj):
    """One for each landmark that has a place where empties are wanted, else none: stale ones would be exported."""
    present = empties_of(obj)
    wanted = context.scene.focal.empties
    placed = {mark.name: mark for mark in obj.focal.landmarks if mark.placed and wanted}
    for name in set(present) - set(placed):
        bpy.data.objects.remove(present.pop(name))
    if not placed:
        _remove_collection(obj)
        return
    size = _EMPTY_SHARE * max((Vector(obj.bound_box[6]) - Vector(obj.bound_box[0])).length, 1e-6)
    for name, mark in placed.items():
        empty = present.get(name) or _new_empty(context, obj, name)
        empty.location = mark.position
        empty.empty_display_size = size
        empty.empty_display_type = _STATUS_SHAPE[mark.status]
        empty.color = colour_of(mark)
        empty["focal_status"] = mark.status.lower()
        empty["focal_confidence"] = mark.confidence


def _new_empty(context, obj, name):
    empty = bpy.data.objects.new(name, None)
    empty["focal_landmark"] = name
    empty.parent = obj
    empty.show_in_front = True
    _collection_of(context, obj).objects.link(empty)
    return empty


def _remove_collection(obj):
    """Unless the user keeps something there."""
    collection = bpy.data.collections.get(f"{obj.name} landmarks")
    if collection is not None and not collection.all_objects and not collection.children:
        bpy.data.collections.remove(collection)


def _collection_of(context, obj):
    """Of its own, so that all empties of a mesh can be hidden at once."""
    name = f"{obj.name} landmarks"
    collection = bpy.data.collections.get(name)
    if collection is None:
        collection = bpy.data.collections.new(name)
        collection.color_tag = "COLOR_04"
    if collection.name not in context.scene.collection.children_recursive:
        holder = obj.users_collection[0] if obj.users_collection else context.scene.collection
        if collection.name not in holder.children:
            holder.children.link(collection)
    return collection


def heat_colours(values):
    """Votes 0..1 as colours from dark blue over green and yellow to red."""
    stops = numpy.array([0.0, 0.15, 0.4, 0.7, 1.0])
    colours = numpy.array([[0.01, 0.02, 0.10], [0.02, 0.12, 0.45], [0.05, 0.55, 0.25], [0.90, 0.75, 0.05],
                           [0.85, 0.03, 0.01]])
    out = numpy.ones((len(values), 4), dtype=numpy.float32)
    for channel in range(3):
        out[:, channel] = numpy.interp(values, stops, colours[:, channel])
    return out


def part_colours(labels):
    """One colour a label, neighbours in number far apart in hue; grey for none."""
    hues = (numpy.maximum(labels, 0) * 0.618033988749895) % 1.0
    level = numpy.where(numpy.maximum(labels, 0) % 2 == 0, 0.80, 0.50)
    out = numpy.ones((len(labels), 4), dtype=numpy.float32)
    for channel, shift in enumerate((0.0, 2 / 3, 1 / 3)):
        ramp = numpy.clip(numpy.abs((hues + shift) % 1.0 * 6 - 3) - 1, 0, 1)
        out[:, channel] = level * (0.25 + 0.75 * ramp)
    out[labels < 0, :3] = 0.2
    return out


def write_colours(mesh, name, domain, colours):
    """A colour attribute, made or overwritten, and shown. domain: POINT or CORNER."""
    attribute = mesh.color_attributes.get(name)
    if attribute is not None and (attribute.domain != domain or len(attribute.data) != len(colours)):
        mesh.color_attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.color_attributes.new(name, "FLOAT_COLOR" if domain == "POINT" else "BYTE_COLOR", domain)
    attribute.data.foreach_set("color", numpy.ascontiguousarray(colours, dtype=numpy.float32).ravel())
    mesh.color_attributes.active_color = mesh.color_attributes[name]
    mesh.update()


def remove_colours(mesh, name):
    """Whether there was such an attribute."""
    attribute = mesh.color_attributes.get(name)
    if attribute is None:
        return False
    mesh.color_attributes.remove(attribute)
    mesh.update()
    return True


def hide_colours(context):
    """Back to colours of materials where solid views show an attribute's."""
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D" and area.spaces.active.shading.color_type == "VERTEX":
            area.spaces.active.shading.color_type = "MATERIAL"


def show_colours(context):
    """Solid shading in colours of the attribute, in the views that show solid."""
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D" and area.spaces.active.shading.type == "SOLID":
            area.spaces.active.shading.color_type = "VERTEX"
