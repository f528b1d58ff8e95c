# SPDX-License-Identifier: Apache-2.0
# Run by Blender: blender --background --factory-startup --python blender_judge.py -- FILE...
# Prints one line `VERDICT {json}` for each file: empty if it loads as one skinned mesh that stands in its bind pose and moves when a joint is turned.
import json
import sys

import bpy
import numpy
from mathutils import Quaternion, Vector

numpy.bool = bool  # Debian's glTF importer still uses the name that Debian's NumPy has dropped


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def skinned(mesh):
    return any(m.type == 'ARMATURE' and m.object for m in mesh.modifiers)


def posed_vertices(mesh):
    evaluated = mesh.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [evaluated.matrix_world @ v.co for v in evaluated.to_mesh().vertices]


def largest_move(before, after):
    return max((a - b).length for a, b in zip(before, after))


# The bone with the largest sum of weights, but for a root if there is another.
def heaviest_bone(mesh, armature):
    sums = {group.index: 0.0 for group in mesh.vertex_groups}
    for vertex in mesh.data.vertices:
        for group in vertex.groups:
            sums[group.group] += group.weight
    by_name = {group.name: sums[group.index] for group in mesh.vertex_groups}
    others = [b for b in armature.pose.bones if b.parent] or list(armature.pose.bones)
    return max(others, key=lambda b: by_name.get(b.name, 0.0))


# Where the vertices stand when the armature is in its rest pose, whatever pose the file's joints are in.
def rest_vertices(mesh, armature):
    armature.data.pose_position = 'REST'
    rest = posed_vertices(mesh)
    armature.data.pose_position = 'POSE'
    return rest


def judge(path):
    clear()
    bpy.ops.import_scene.gltf(filepath=path)
    custom_shapes = {b.custom_shape for o in bpy.data.objects if o.type == 'ARMATURE' for b in o.pose.bones}  # the importer's own
    meshes = [o for o in bpy.data.objects if o.type == 'MESH' and o not in custom_shapes]
    armatures = [o for o in bpy.data.objects if o.type == 'ARMATURE']
    if len(meshes) != 1 or not skinned(meshes[0]):
        return f'{len(meshes)} meshes, {sum(map(skinned, meshes))} skinned, instead of one skinned mesh'
    if len(armatures) != 1:
        return f'{len(armatures)} armatures instead of one'
    mesh, armature = meshes[0], armatures[0]
    rest, posed = rest_vertices(mesh, armature), posed_vertices(mesh)
    size = max((v - rest[0]).length for v in rest)
    drift = largest_move(rest, posed)
    if not drift <= 1e-4 * size:
        return f'the joints do not stand in their bind pose: {drift} of {size}'
    bone = heaviest_bone(mesh, armature)
    bone.rotation_mode = 'QUATERNION'
    bone.rotation_quaternion = bone.rotation_quaternion @ Quaternion(Vector((1, 1, 1)).normalized(), 0.8)
    bpy.context.view_layer.update()
    move = largest_move(rest, posed_vertices(mesh))
    return '' if move > 1e-3 * size else f'turning {bone.name} moves vertices by {move} of {size} only'


for path in sys.argv[sys.argv.index('--') + 1:]:
    try:
        verdict = judge(path)
    except Exception as e:  # whatever Blender throws at a file is a verdict on it
        verdict = f'not readable: {e}'
    print('VERDICT', json.dumps({'file': path, 'verdict': verdict}), flush=True)
