//! Skins in their rest pose: joints where the file's nodes put them, no animation.
//!
//! glTF 2.0, section 3.7.3: a skinned mesh stands where its joints put it, and its own node's transform is not
//! applied. A vertex goes to `Σ weight · joint · inverse bind · position`.

use std::collections::HashMap;

use gltf::json::Root;
use gltf::json::mesh::Semantic;

use crate::ImportError;

use super::accessor::Accessors;
use super::attributes::Attributes;
use super::primitive::Piece;
use super::transform::Transform;

/// What one vertex hangs on: up to four joints of the skin a set, with weights.
pub(super) type Bond = Vec<(u32, f64)>;

/// Sets of four joints that are read; files with more than two are not known.
const SETS: u32 = 4;

/// Empty where the primitive has no joints.
pub(super) fn bonds(
    attributes: &Attributes<'_>,
    vertices: usize,
    place: &str,
) -> Result<Vec<Bond>, ImportError> {
    let mut bonds = Vec::new();
    for set in 0..SETS {
        let joints = attributes.vectors::<4>(&Semantic::Joints(set))?;
        let Some((joints, weights)) = joints.zip(attributes.vectors::<4>(&Semantic::Weights(set))?) else {
            break;
        };
        if joints.len() < vertices || weights.len() < vertices {
            let reason = format!("expected joints and weights for {vertices} vertices, found fewer");
            return Err(ImportError::malformed(format!("{place}.attributes"), reason));
        }
        bonds.resize(vertices, Bond::new());
        for (bond, (joints, weights)) in bonds.iter_mut().zip(joints.iter().zip(&weights)) {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            bond.extend(
                joints
                    .iter()
                    .zip(weights)
                    .filter(|(_, weight)| **weight > 0.0)
                    .map(|(&joint, &weight)| (joint as u32, weight)),
            );
        }
    }
    Ok(bonds)
}

/// Where each joint of a skin takes the bind pose.
pub(super) fn joints(
    skin: usize,
    accessors: &Accessors<'_>,
    globals: &[Transform],
) -> Result<Vec<Transform>, ImportError> {
    let root = accessors.root;
    let place = format!("skins[{skin}]");
    let Some(of) = root.skins.get(skin) else {
        return Err(ImportError::malformed(place, format!("there are {} skins", root.skins.len())));
    };
    let inverse_binds = match of.inverse_bind_matrices {
        Some(index) => accessors.vectors::<16>(index.value(), &format!("{place}.inverseBindMatrices"))?,
        None => Vec::new(),
    };
    of.joints
        .iter()
        .enumerate()
        .map(|(at, joint)| {
            let Some(global) = globals.get(joint.value()) else {
                let reason = format!("refers to nodes[{}], there are {}", joint.value(), globals.len());
                return Err(ImportError::malformed(format!("{place}.joints[{at}]"), reason));
            };
            let inverse_bind =
                inverse_binds.get(at).map_or(Transform::IDENTITY, |matrix| Transform::of_columns(*matrix));
            Ok(global.after(&inverse_bind))
        })
        .collect()
}

/// The piece's positions in the scene, and whether the joints mirror it.
///
/// # Errors
/// Why the piece cannot be skinned, to be noted.
pub(super) fn posed(piece: &Piece, joints: &[Transform]) -> Result<(Vec<[f64; 3]>, bool), String> {
    let bonds = piece.bonds.as_ref().map_err(Clone::clone)?;
    if bonds.is_empty() {
        return Err("the mesh has no joints and weights".to_owned());
    }
    let mut mirrored = 0_usize;
    let mut posed = Vec::with_capacity(piece.positions.len());
    for (position, bond) in piece.positions.iter().zip(bonds) {
        let sum: f64 = bond.iter().map(|(_, weight)| weight).sum();
        if sum <= 0.0 {
            return Err("a vertex hangs on no joint".to_owned());
        }
        let mut parts = Vec::with_capacity(bond.len());
        for &(joint, weight) in bond {
            let count = joints.len();
            let joint = joints.get(joint as usize);
            parts.push((
                weight / sum,
                *joint.ok_or_else(|| format!("a vertex hangs on a joint beyond {count}"))?,
            ));
        }
        let blend = Transform::blend(parts.into_iter());
        mirrored += usize::from(blend.determinant() < 0.0);
        posed.push(blend.apply(*position));
    }
    Ok((posed, 2 * mirrored > piece.positions.len()))
}

/// Where the first vertex of each place in the bind pose went.
pub(super) type Seams = HashMap<[u64; 3], [f64; 3]>;

/// Keeps vertices together that are in one place in the bind pose: exporters weight the two sides of a seam a little
/// differently, which would tear a closed surface open.
pub(super) fn close_seams(bind: &[[f64; 3]], posed: &mut [[f64; 3]], seams: &mut Seams) {
    for (bind, posed) in bind.iter().zip(posed) {
        // Adding 0 turns -0 into 0.
        *posed = *seams.entry(bind.map(|value| (value + 0.0).to_bits())).or_insert(*posed);
    }
}

/// Every node's transform in the scene's frame, along its first parent; a node of a cycle keeps its own.
pub(super) fn globals(root: &Root, locals: &[Transform]) -> Vec<Transform> {
    let count = root.nodes.len().min(locals.len());
    let mut parent = vec![None; count];
    for (at, node) in root.nodes.iter().enumerate().take(count) {
        for child in node.children.iter().flatten() {
            if let Some(slot @ None) = parent.get_mut(child.value()) {
                *slot = Some(at);
            }
        }
    }
    let mut globals = locals.to_vec();
    let mut done = vec![false; count];
    let mut path = Vec::new();
    for start in 0..count {
        let mut at = start;
        while !done[at] {
            done[at] = true;
            path.push(at);
            match parent[at] {
                Some(above) => at = above,
                None => break,
            }
        }
        while let Some(node) = path.pop() {
            if let Some(above) = parent[node] {
                globals[node] = globals[above].after(&locals[node]);
            }
        }
    }
    globals
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shifted(x: f64) -> Transform {
        Transform([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [x, 0.0, 0.0]])
    }

    fn piece(bonds: Vec<Bond>) -> Piece {
        Piece {
            positions: vec![[0.0, 1.0, 0.0]; bonds.len()],
            triangles: Vec::new(),
            targets: Vec::new(),
            bonds: Ok(bonds),
        }
    }

    #[test]
    fn weights_blend_and_are_made_to_sum_to_one() {
        let piece = piece(vec![vec![(0, 1.0), (1, 3.0)], vec![(1, 0.5)]]);
        let (posed, mirrored) = posed(&piece, &[shifted(0.0), shifted(4.0)]).unwrap();
        assert_eq!((posed, mirrored), (vec![[3.0, 1.0, 0.0], [4.0, 1.0, 0.0]], false));
    }

    #[test]
    fn a_seam_stays_closed() {
        let bind = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, -0.0, 0.0]];
        let mut posed = [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.1, 0.0, 0.0]];
        close_seams(&bind, &mut posed, &mut Seams::default());
        assert_eq!(posed, [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
    }

    #[test]
    fn a_bond_that_cannot_be_is_an_error() {
        assert!(posed(&piece(vec![vec![(7, 1.0)]]), &[shifted(0.0)]).is_err());
        assert!(posed(&piece(vec![vec![]]), &[shifted(0.0)]).is_err());
    }

    #[test]
    fn globals_follow_the_first_parent_and_end_on_cycles() {
        let text = r#"{"asset":{"version":"2.0"},"nodes":[{"children":[1]},{"children":[2]},{},
            {"children":[4]},{"children":[3]}]}"#;
        let root: Root = gltf::json::deserialize::from_str(text).unwrap();
        let locals: Vec<Transform> = [1.0, 10.0, 100.0, 5.0, 6.0].map(shifted).to_vec();
        let globals = globals(&root, &locals);
        assert_eq!(globals[2], shifted(111.0));
        assert_eq!(globals.len(), 5);
    }
}
