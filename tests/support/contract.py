"""The contract, clause by clause and row by row, and the tests that hold each: `file` or `file::test`, with commas."""

from __future__ import annotations

CLAUSES: dict[str, tuple[str, str]] = {
    "C1": ("no input crashes, aborts, exits or hangs", "test_damage, test_bad_files, test_bad_arrays, test_odd_shapes"),
    "C2": ("no NaN or inf leaves unless documented", "test_odd_shapes, test_matching_robust, test_metrics"),
    "C3": ("vertex order and count stay; a row a vertex", "test_io, test_correspondence, test_matching_robust"),
    "C4": ("typed errors with code, place and remedy", "test_bad_arrays, test_bad_files, test_mesh"),
    "C5": ("same input, same bits", "test_threads, test_system, test_matching_invariance, test_batch"),
    "C6": ("motion, size, numbering, order do not matter", "test_matching_invariance, test_metrics, test_theorems"),
    "C7": (
        "files whole or untouched; batches resume",
        "test_system, test_batch, test_batch_killed, test_map_damage",
    ),
    "C8": ("memory is refused before it is taken", "test_memory, test_bad_files, test_map_file"),
    "C9": ("no code, no network, no other file", "test_system, test_bad_files, test_map_file"),
    "C10": ("every loop ends, and soon when cancelled", "test_cli::test_interrupting_ends_with_130, test_threads"),
}

ROWS: dict[str, str] = {
    **dict.fromkeys([f"V{i:02}" for i in range(1, 17)], "test_bad_arrays"),
    "V17": "test_landmarks::test_v17_v18_refused, test_landmarks::test_v17_a_vertex_on_no_face",
    "V18": "test_landmarks::test_v17_v18_refused, "
           "test_landmarks::test_v18_positions_near_the_surface_are_moved_to_it_and_the_move_is_told",
    "V19": "test_landmarks::test_v19_sample_counts_are_refused_never_clamped",
    "V20": "test_landmarks::test_v20_did_you_mean, test_matching::test_bad_options_are_refused_by_name",
    "G01": "test_odd_shapes, test_fast_marching::test_repeated_improper_and_turned_faces_change_nothing",
    "G02": "test_odd_shapes, test_matching_robust::test_duplicate_vertices_and_degenerate_faces_change_little",
    "G03": "test_odd_shapes, test_repair",
    "G04": "test_odd_shapes, test_spectrum::test_slivers, "
           "test_fast_marching::test_exact_geodesics_on_a_mesh_of_slivers",
    "G05": "test_odd_shapes, test_matching_robust::test_an_edge_of_three_faces_is_no_obstacle",
    "G06": "test_odd_shapes, test_matching_robust::test_two_surfaces_that_meet_in_a_vertex_are_one",
    "G07": "test_odd_shapes, test_matching_robust::test_isolated_vertices_are_kept_and_have_no_counterpart",
    "G08": "test_odd_shapes, test_matching_robust::test_a_small_second_component_has_no_counterpart",
    "G09": "test_odd_shapes, test_spectrum::test_disc_held_fixed_has_the_zeros_of_bessel_functions",
    "G10": "test_odd_shapes, test_matching_robust",
    "G11": "test_odd_shapes, test_check, test_matching_invariance::test_faces_turned_over_do_not_matter",
    "G12": "test_odd_shapes, test_check::test_a_moebius_strip_has_no_orientation_and_stays_as_it_is",
    "G13": "test_odd_shapes, test_notes, test_matching_robust",
    "G14": "test_odd_shapes, test_notes, test_theorems::test_flat_surface_is_measured_as_it_is",
    "G15": "test_odd_shapes, test_metrics::test_arc_lengths_on_a_cylinder, test_fast_marching::test_cone",
    "G16": "test_odd_shapes, test_notes, test_diffusion, test_matching_robust",
    "G17": "test_matching::test_the_mirrored_map_of_an_animal_is_a_candidate",
    "G18": "test_matching::test_the_map_of_a_surface_to_itself_is_the_identity",
    "G19": "test_matching_invariance",
    "G20": "test_odd_shapes, test_check::test_far_from_the_origin_is_reported, "
           "test_matching_invariance::test_far_from_the_origin_the_map_is_the_same",
    "G21": "test_odd_shapes, test_spectrum::test_tiny_meshes_give_what_they_have",
    "G22": "test_bad_arrays",
    "G23": "test_odd_shapes",
    "G24": "test_odd_shapes, test_matching_robust::test_surfaces_of_different_kinds_are_matched_poorly_but_finitely",
    "G25": "test_odd_shapes, test_check::test_each_defect_is_found_where_it_is",
    "G26": "test_odd_shapes, test_matching_robust",
    "G27": "test_large_surfaces",
    "G28": "test_memory",
    "G29": "test_spectrum::test_not_finite_is_a_typed_error, "
           "test_spectrum::test_needles_inside_a_good_mesh_do_not_disturb_it",
    "G30": "test_solver::test_stress_never_rises, test_solver::test_distances_that_are_not_numbers",
    **dict.fromkeys([f"F{i:02}" for i in range(1, 18)], "test_bad_files"),
    "F07": "test_truncation, test_bad_files",
    "F16": "test_bad_files, test_batch_parts::test_names_are_different_and_make_one_pair_each",
    "F18": "test_map_file",
    "S01": "test_map_file::test_pickles_are_never_opened, test_bad_files",
    "S02": "test_map_file::test_a_lying_header_costs_nothing",
    "S03": "test_bad_files::test_s03_nothing_but_the_named_file_is_opened, test_system",
    "S04": "test_bad_files",  # XML is read by nothing here
    "S05": "test_system, test_io::test_writing_through_a_link_or_over_a_file",
    "S06": "test_doctor::test_a_folder_that_can_not_be_written",
    "S07": "test_report::test_nothing_in_names_titles_or_meta_becomes_markup, "
           "test_report_browser::test_names_are_shown_as_they_are_and_run_nothing",
    "S08": "test_table::test_no_name_stands_bare_at_the_start_of_a_cell, test_table::test_nobody_else_writes_tables, "
           "test_table::test_landmarks_keep_their_names",
    "S09": "test_system::test_s09_c9_nothing_is_reached_or_opened_but_what_was_named",
    "B01": "test_system::test_b01_a_killed_writer_leaves_the_old_file_or_the_new_one, "
           "test_batch_killed::test_what_is_done_is_kept",
    "B02": "test_system::test_b02_a_full_disk_leaves_the_old_file_and_no_other",
    "B03": "test_system::test_b03_a_folder_that_can_not_be_written_is_named, "
           "test_system::test_b03_without_a_place_for_compiled_kernels_they_are_compiled_again",
    "B04": "test_system::test_b04_writers_of_one_file_do_not_mix, "
           "test_batch::test_a_second_run_in_the_same_folder_is_refused",
    "B05": "test_batch::test_workers_killed_at_random_change_nothing, "
           "test_batch::test_a_pair_that_kills_its_workers_is_given_up",
    "B06": "test_cli::test_interrupting_ends_with_130",
    "B07": "test_batch::test_what_is_damaged_missing_or_not_what_was_asked_for_is_done_again",
    "B08": "test_batch_parts::test_a_line_cut_short_harms_no_other",
    "B09": "test_system::test_b09_forks_threads_and_pickles_give_the_same_bytes, test_threads",
    "B10": "test_system::test_c5_b10_a_map_does_not_depend_on_the_interpreter_or_its_surroundings",
}  # fmt: skip
