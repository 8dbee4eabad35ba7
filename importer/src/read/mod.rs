//! Model files to geometry and names.

mod accessor;
mod attributes;
mod binvox;
mod buffers;
mod draco;
mod extension;
mod glb;
mod gltf;
mod instancing;
mod meshopt;
mod notes;
mod obj;
mod off;
mod pcd;
mod physics;
mod ply;
mod ply_header;
mod primitive;
mod reading;
mod shapes;
mod skin;
mod sniff;
mod stl;
mod transform;
mod vox;
mod voxels;
mod words;
mod xyz;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::asset::{Format, Source};
use crate::{ImportError, Options, guard, hash};
use notes::Notes;
use reading::Reading;
pub(crate) use sniff::is_shapes;

/// Reads one model file: glTF 2.0, GLB (both also packed by Draco or meshopt), OBJ, STL (binary and text), PLY (text and
/// binary, both byte orders), OFF; point clouds (PLY, OBJ, glTF and OFF without faces, XYZ, PCD); voxels (MagicaVoxel,
/// binvox); analytical shapes (`*.shapes.yaml`, glTF's implicit shapes).
///
/// Positions come out in file units with node transforms applied, triangles counter-clockwise seen from
/// outside as far as the file says so. Faces that refer to vertices which are not there, or not finite, are
/// left out and noted.
///
/// # Errors
/// A refusal that names the file, the place in it, the fault and the way out; see [`ImportError`]. A file
/// without triangles is refused.
pub fn read(path: &Path, options: &Options) -> Result<Source, ImportError> {
    let bytes = guard::catch("read", || file_bytes(path, options.max_file_bytes));
    bytes.map_err(|error| error.in_file(path)).and_then(|bytes| read_bytes(path, &bytes, options))
}

/// The same of bytes in memory. `path` names them: its extension helps to tell the format, and files that they refer to
/// are looked for beside it.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(path: &Path, bytes: &[u8], options: &Options) -> Result<Source, ImportError> {
    guard::catch("read", || {
        let mut notes = Notes::default();
        let format = sniff::format_of(path, bytes, &mut notes)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut reading = Reading { notes, ..Reading::default() };
        match format {
            Format::Glb | Format::Gltf => gltf::read(bytes, format, folder, options, &mut reading),
            Format::Obj => obj::read(bytes, options, &mut reading),
            Format::Stl => stl::read(bytes, options, &mut reading),
            Format::Ply => ply::read(bytes, options, &mut reading),
            Format::Off => off::read(bytes, options, &mut reading),
            Format::Xyz => xyz::read(bytes, options, &mut reading),
            Format::Pcd => pcd::read(bytes, options, &mut reading),
            Format::Vox => vox::read(bytes, options, &mut reading),
            Format::Binvox => binvox::read(bytes, options, &mut reading),
            Format::Shapes => shapes::read(bytes, options, &mut reading),
        }?;
        let key = hash::key_of(bytes, reading.referred.iter().map(Vec::as_slice));
        reading.finish(key, format, options)
    })
    .map_err(|error| error.in_file(path))
}

/// The whole file, unless it is over the limit; a file that grows while it is read stays under it too.
pub(super) fn file_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, ImportError> {
    let refuse = |source| ImportError::Io { file: path.to_path_buf(), source };
    let file = File::open(path).map_err(refuse)?;
    let metadata = file.metadata().map_err(refuse)?;
    if metadata.is_dir() {
        return Err(refuse(std::io::Error::from(std::io::ErrorKind::IsADirectory)));
    }
    let size = metadata.len();
    let mut bytes = Vec::new();
    if size <= limit {
        bytes.reserve_exact(usize::try_from(size).unwrap_or(0).saturating_add(1));
        file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(refuse)?;
    }
    if size > limit || bytes.len() as u64 > limit {
        let size = size.max(bytes.len() as u64);
        return Err(ImportError::too_large("", format!("{size} bytes, the limit is {limit}")));
    }
    Ok(bytes)
}
