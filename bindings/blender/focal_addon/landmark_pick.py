"""Placing landmarks by clicking on the mesh, one name after the other."""
import bpy
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

from . import correction, display, landmark_data, names
from .geometry import Surface, Unusable
from .landmark_data import active_of
from .view_events import is_for_view, view_region

_END = {"ESC", "RIGHTMOUSE", "RET", "NUMPAD_ENTER"}

_running = False  # one at a time: a second one would take the first one's clicks


class FOCAL_OT_landmark_pick(bpy.types.Operator):
    """Click on the mesh to place the active landmark and go on to the next one without a place. The view can be turned as usual.
Backspace undoes the last click, Tab skips a landmark, Esc or the right button ends"""
    bl_idname = "focal.landmark_pick"
    bl_label = "Place by Clicking"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if _running:
            cls.poll_message_set("Clicks are being placed already: Esc ends it")
            return False
        return (context.active_object is not None and context.active_object.type == "MESH"
                and context.active_object.mode == "OBJECT")

    def invoke(self, context, event):
        global _running
        if context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, "Start it from the 3D view")
            return {"CANCELLED"}
        try:
            self._surface = Surface(context.active_object)
        except Unusable as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._object = context.active_object.name
        self._past = []  # (number, what it was) of each placed one
        self._passed = set()  # names that Tab passed over
        self._unsaved = False  # whether something is left for this operator's own step of undo
        self._only_add = not len(context.active_object.focal.landmarks)
        context.window.cursor_modal_set("CROSSHAIR")
        context.window_manager.modal_handler_add(self)
        _running = True
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        try:
            return self._handle(context, event)
        except Exception:
            self._end(context)  # else no second one could ever start
            raise

    def _handle(self, context, event):
        obj = context.active_object
        if obj is None or obj.name != self._object or obj.mode != "OBJECT":
            return self._end(context)
        if event.type in _END and event.value == "PRESS":
            return self._end(context)
        region = view_region(context.area, event.mouse_x, event.mouse_y)
        if region is None or is_for_view(context, event):
            return {"PASS_THROUGH"}
        if event.value == "PRESS":
            if event.type == "LEFTMOUSE":
                self._click(context, event, region)
            elif event.type in {"BACK_SPACE", "Z"}:
                self._take_back(context)
            elif event.type == "TAB" and not event.ctrl:
                self._pass_over(obj)
            self._tell(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        self._end(context)

    def _click(self, context, event, region):
        obj = context.active_object
        coordinates = event.mouse_x - region.x, event.mouse_y - region.y
        view = context.area.spaces.active.region_3d
        to_local = obj.matrix_world.inverted()
        origin = to_local @ region_2d_to_origin_3d(region, view, coordinates)
        direction = to_local.to_3x3() @ region_2d_to_vector_3d(region, view, coordinates)
        hit = self._surface.cast(origin, direction.normalized())
        if hit is None:
            return
        location, triangle = hit
        mark = self._next_mark(obj)
        self._past.append((obj.focal.active, _state_of(mark)))
        landmark_data.place(obj, mark, self._surface, triangle, self._surface.barycentric(triangle, location))
        self._go_on(obj)
        self._show(context, obj)

    def _show(self, context, obj):
        """Other landmarks of a detected mesh follow, which is a step of undo with the click in it."""
        display.refresh(context, obj)
        try:
            self._unsaved = not correction.follow(context, obj, True, with_step=True)
        except RuntimeError as error:  # with which an operator refuses
            self._unsaved = True
            self.report({"WARNING"}, str(error))

    def _next_mark(self, obj):
        """Without names to fill in, each click makes a new landmark."""
        mark = active_of(obj)
        if mark is None or (self._only_add and mark.placed):
            mark = obj.focal.landmarks.add()
            mark.name = names.free_name("point", {m.name for m in obj.focal.landmarks})
            obj.focal.active = len(obj.focal.landmarks) - 1
        return mark

    def _go_on(self, obj):
        at = self._next(obj)
        if at < 0 and self._passed:
            self._passed.clear()  # all that is left was passed over: once more
            at = self._next(obj)
        if at >= 0:
            obj.focal.active = at

    def _pass_over(self, obj):
        """Tab leads on and never back to what was passed over in this round, such as the other side of a pair."""
        mark = active_of(obj)
        if mark is not None:
            self._passed.add(mark.name)
            self._go_on(obj)

    def _next(self, obj):
        """Pairs are marked together: after elbow.L comes elbow.R where that has no place yet."""
        mark, count = active_of(obj), len(obj.focal.landmarks)
        partner = landmark_data.index_of(obj, names.mirrored(mark.name) or "") if mark is not None else -1
        numbers = [partner] if partner >= 0 else []
        numbers += [(obj.focal.active + step) % count for step in range(1, count + 1)]
        return next((at for at in numbers if self._waits(obj.focal.landmarks[at])), -1)

    def _waits(self, mark):
        return mark.status == "UNPLACED" and mark.name not in self._passed

    def _take_back(self, context):
        if not self._past:
            return
        obj = context.active_object
        number, state = self._past.pop()
        if number < len(obj.focal.landmarks):
            obj.focal.active = number
            _restore(obj.focal.landmarks[number], state)
            self._show(context, obj)

    def _tell(self, context):
        mark = active_of(context.active_object)
        placed, total, _ = landmark_data.counts(context.active_object)
        what = f"{mark.name}  ({placed} of {total} placed)" if mark is not None else "a new landmark"
        context.workspace.status_text_set(
            f"Click: {what}      Backspace: take back      Tab: pass over      Esc: end")
        if context.area is not None:
            context.area.header_text_set(f"Click on the mesh: {what}")

    def _end(self, context):
        global _running
        _running = False
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)
        for area in context.screen.areas:
            if area.type == "VIEW_3D":
                area.header_text_set(None)
        return {"FINISHED"} if self._past and self._unsaved else {"CANCELLED"}


@bpy.app.handlers.persistent
def _forget(*_):
    """Another file ends whatever ran."""
    global _running
    _running = False


_FIELDS = ("triangle", "status", "confidence", "expected_error", "told_absent")


def _state_of(mark):
    return [getattr(mark, f) for f in _FIELDS] + [tuple(mark.barycentric), tuple(mark.position)]


def _restore(mark, state):
    for field, value in zip(_FIELDS, state):
        setattr(mark, field, value)
    mark.barycentric, mark.position = state[-2:]


def register():
    bpy.utils.register_class(FOCAL_OT_landmark_pick)
    bpy.app.handlers.load_post.append(_forget)


def unregister():
    bpy.app.handlers.load_post.remove(_forget)
    bpy.utils.unregister_class(FOCAL_OT_landmark_pick)
