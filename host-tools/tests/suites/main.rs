//! The suites of the host tool, one module each: in one program, which links once.

mod amc_bad_input;
mod amc_real_clips;
mod angles;
mod banks;
mod batch_command;
mod bvh_bad_input;
mod bvh_real_clips;
mod by_channel;
mod cli_reference;
mod convert_laws;
mod documents;
mod edits;
mod events;
mod exhaustion;
mod export_source;
mod face_laws;
mod face_meshes;
mod face_model;
mod face_real_clips;
mod face_speak;
mod fap_input;
#[cfg(feature = "fbx")]
mod fbx_input;
#[cfg(feature = "fbx")]
mod fbx_real_files;
mod figure;
mod format_example;
mod gltf_input;
mod gltf_real_files;
mod import_hostile;
mod info_command;
mod interchange;
mod keyframes_input;
mod livelink_input;
mod manners;
mod mean_error;
mod motions_library;
mod optimum;
mod outputs;
mod own_clips;
mod own_motions;
#[cfg(unix)]
mod play_command;
mod procedural_input;
mod rates_and_loops;
mod real;
mod render_command;
mod same_form;
mod scalars_command;
mod serve;
mod source_places;
mod table_input;
mod terminal;
mod update_command;
mod vrml_input;
mod vrml_real_files;
