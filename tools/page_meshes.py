"""Makes the meshes that the teaching page shows, from those of panda_tray_description.

The originals have 95,000 faces and 8.5 MB of text, which a browser without a graphics card draws seven times a second.
These keep the shape with an eighth of them. Run once; the result is part of teach_page_node:

    pip install trimesh==5.2.0 fast-simplification==0.2.0 scipy
    python tools/page_meshes.py ros2_ws/src/teach_page_node/teach_page_node/static/meshes
"""

import sys
from pathlib import Path

import numpy as np
import trimesh
from panda_tray_description import URDF_PATH
from trimesh.visual.material import PBRMaterial
from trimesh.visual.texture import TextureVisuals

FACES_OF_A_LINK = 2000
SHARP_EDGE = np.radians(35)
WHITE, DARK = (0.93, 0.93, 0.92), (0.25, 0.26, 0.28)


def main() -> None:
    """Entry point."""
    output = Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    for file in sorted((URDF_PATH.parent.parent / 'meshes' / 'visual').glob('link*.obj')):
        link = trimesh.load(file, force='scene')
        parts = {WHITE: [], DARK: []}
        for part in link.geometry.values():
            parts[_colour(part)].append(trimesh.Trimesh(part.vertices, part.faces))
        total = sum(len(part.faces) for same in parts.values() for part in same)
        scene = trimesh.Scene()
        for colour, same in parts.items():
            if same:
                scene.add_geometry(_simplified(trimesh.util.concatenate(same), total, colour))
        (output / f'{file.stem}.glb').write_bytes(scene.export(file_type='glb', include_normals=True))
        print(file.stem, total, '->', sum(len(g.faces) for g in scene.geometry.values()))


def _colour(part: trimesh.Trimesh) -> tuple[float, float, float]:
    """Franka's parts are white or nearly black; in these files some materials have marking colours, too."""
    diffuse = getattr(getattr(part.visual, 'material', None), 'diffuse', (255, 255, 255))
    return DARK if max(diffuse[:3]) < 128 else WHITE


def _simplified(mesh: trimesh.Trimesh, faces_of_link: int, colour: tuple[float, float, float]) -> trimesh.Trimesh:
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    target = max(round(FACES_OF_A_LINK * len(mesh.faces) / faces_of_link), 12)
    if target < len(mesh.faces):
        mesh = mesh.simplify_quadric_decimation(face_count=target)
    mesh = trimesh.graph.smooth_shade(mesh, angle=SHARP_EDGE)
    mesh.visual = TextureVisuals(material=PBRMaterial(
        baseColorFactor=(*colour, 1.0), metallicFactor=0.0, roughnessFactor=0.6))
    return mesh


if __name__ == '__main__':
    main()
