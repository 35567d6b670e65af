"""What of a modal operator's events belongs to the 3D view: looking around must go on while points are clicked."""

# Everything whose name begins so: timers move the view softly, and the numpad turns it.
_PASSED = ("TIMER", "WHEEL", "TRACKPAD", "NDOF", "NUMPAD_", "WINDOW_", "ACTIONZONE", "BUTTON", "LEFT_", "RIGHT_")
# ACCENT_GRAVE and Z open pies, N and T the sidebars, HOME shows all.
_KEYS = {"MIDDLEMOUSE", "MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "MOUSEROTATE", "MOUSESMARTZOOM", "OSKEY", "NONE", "HOME",
         "ACCENT_GRAVE", "Z", "N", "T"}
_DIGITS = {"ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE"}

# Of the navigation gizmo, in pixels at a scale of 1: the border round its ball, the width and height of its buttons.
_BORDER, _BUTTON_WIDTH, _BUTTON_HEIGHT, _BUTTONS = 12, 44, 34, 5


def is_for_view(context, event):
    """Whether the view wants this event and no scene is changed by it."""
    inputs = context.preferences.inputs
    if event.type in _DIGITS:
        return inputs.use_emulate_numpad
    if event.type == "LEFTMOUSE":
        return (event.alt and inputs.use_mouse_emulate_3_button) or over_gizmo(context, event.mouse_x, event.mouse_y)
    if event.type == "Z" and (event.ctrl or event.oskey):
        return False
    return event.type in _KEYS or event.type.startswith(_PASSED)


def view_region(area, x, y):
    """The region of the 3D view at a place of the window; None over panels and other editors."""
    if area is None or area.type != "VIEW_3D":
        return None
    found = None
    for region in area.regions:
        inside = region.width > 1 and region.x <= x < region.x + region.width and region.y <= y < region.y + region.height
        if inside and region.type != "WINDOW":
            return None  # panels lie over the view
        if inside:
            found = region
    return found


def over_gizmo(context, x, y):
    """Whether the navigation gizmo is at this place of the window: Blender does not say which gizmo the mouse is over."""
    area, view = context.area, context.preferences.view
    if area is None or area.type != "VIEW_3D" or not (area.spaces.active.show_gizmo and area.spaces.active.show_gizmo_navigate):
        return False
    right, top = _free_corner(area)
    scale = context.preferences.system.ui_scale
    ball = view.gizmo_size_navigate_v3d + 2 * _BORDER if view.mini_axis_type == "GIZMO" else 0
    across, down = (right - x) / scale, (top - y) / scale
    return (0 <= across < ball and 0 <= down < ball) or (
        0 <= across < _BUTTON_WIDTH and 0 <= down < ball + _BORDER + _BUTTONS * _BUTTON_HEIGHT)


def _free_corner(area):
    """The upper right corner of what the sidebars and headers leave of the view."""
    window = next(region for region in area.regions if region.type == "WINDOW")
    right, top = window.x + window.width, window.y + window.height
    for region in area.regions:
        if region.width <= 1 or region.height <= 1:
            continue
        if region.type == "UI" and region.alignment == "RIGHT":
            right = min(right, region.x)
        if region.type in {"HEADER", "TOOL_HEADER"} and region.y > window.y + window.height / 2:
            top = min(top, region.y)
    return right, top
