# SPDX-License-Identifier: GPL-3.0-or-later
"""focal for Blender: rigs characters, and finds landmarks learned from some marked meshes."""
bl_info = {
    "name": "focal",
    "description": "Learn landmarks and rigs from a few meshes, find them on others",
    "author": "The focal authors",
    "version": (0, 1, 0),
    "blender": (3, 3, 0),
    "location": "3D View > Sidebar > focal",
    "category": "Rigging",
}

from . import (batch, binding, correction, detection, engine, jobs, landmark_edit, landmark_exchange,  # noqa: E402
               landmark_pick, model_files, overlay, panel_skeleton, panels, preferences, properties, rigging, rigify,
               segmentation, template_edit, training, vote_map)

_MODULES = (properties, preferences, model_files, jobs, landmark_edit, landmark_exchange, landmark_pick, template_edit, training,
            detection, correction, rigging, rigify, binding, segmentation, batch, vote_map, panels, panel_skeleton, overlay)

# Blender's glTF importer and exporter look for these names in each add-on.
glTF2ExportUserExtension = landmark_exchange.SettingsStay
glTF2ImportUserExtension = landmark_exchange.LandmarksOfFile


def register():
    for module in _MODULES:
        module.register()
    # The add-on must be usable without the library: its preferences are where the user fixes the path.
    if not engine.ready():
        print(f"focal: {engine.problem()}")


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
