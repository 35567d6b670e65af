"""Characters through Blender's own glTF exporter: skeletons and weights reach focal as files."""
import bpy
import numpy

from .geometry import Unusable, armature_of

_PLAIN = {"export_format": "GLB", "use_selection": True, "export_skins": True, "export_yup": True,
          "export_apply": False, "export_animations": False, "export_materials": "NONE", "export_texcoords": False,
          "export_morph": False, "export_cameras": False, "export_lights": False, "export_all_influences": False}


def export_character(context, objects, path):
    """Writes the meshes of one character and their armature, and nothing else, to a .glb; gives the path."""
    if not hasattr(bpy.types, "EXPORT_SCENE_OT_gltf"):
        raise Unusable("Switch on Blender's add-on 'glTF 2.0 format' in the preferences")
    # Exporters of before 2023 ask NumPy for names that it has dropped since.
    if not hasattr(numpy, "bool"):
        numpy.bool = bool
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    options = {name: value for name, value in _PLAIN.items() if name in known}
    with Selection(context, [*objects, armature_of(objects[0])]):
        bpy.ops.export_scene.gltf(filepath=path, **options)
    return path


class Selection:
    """Selects some objects for an operator that looks at the selection; afterwards all is as before."""

    def __init__(self, context, objects):
        self._context, self._objects = context, objects

    def __enter__(self):
        layer = self._context.view_layer
        if layer.objects.active is not None and layer.objects.active.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        self._active, self._selected = layer.objects.active, list(self._context.selected_objects)
        for obj in self._selected:
            obj.select_set(False)
        for obj in self._objects:
            if obj.name not in layer.objects:
                raise Unusable(f"'{obj.name}' is not in this view layer")
            obj.select_set(True)
        layer.objects.active = self._objects[0]

    def __exit__(self, *_):
        for obj in self._objects:
            obj.select_set(False)
        for obj in self._selected:
            obj.select_set(True)
        self._context.view_layer.objects.active = self._active
