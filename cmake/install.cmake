include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/moclean)

install(TARGETS moclean EXPORT moclean-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

# Every header but those only sources of their own folder include: the steps behind a backend, the
# tools behind the readers, the text of the kernels.
set(internal_headers
    "methods/[a-z_]+/(reference|opencl)[a-z_]*" "solve/(reference_svd|opencl/(stacked_rows|transfer))"
    "formats/(text_scanner|plain_number|row_collector|frame_rate|extension|text_lines|text_encoding|table_[a-z]+|column_names|column_roles|new_table|trc_text|bone_finder|bvh_motion|channel_text|skeleton_positions|npy_header|array_columns|zip_archive|missing_marks|confidence|write_whole|c3d_header|c3d_samples|c3d_write|written_text)" "filter/observed"
    "metric/same_shape" "experiment/toml_[a-z]+" "report/(assets|figures|quantised)"
    "run/(batch_rules|busy_clock|byte_size|memory_budget|result_writer|run_log|take_batch|take_page|take_reader|work_queue)")
list(JOIN internal_headers "|" internal_headers)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/host/moclean DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp" REGEX "/(${internal_headers})[.]hpp$" EXCLUDE)
install(EXPORT moclean-targets NAMESPACE moclean:: DESTINATION ${package_dir})

configure_package_config_file(cmake/moclean-config.cmake.in ${PROJECT_BINARY_DIR}/moclean-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/moclean-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/moclean-config.cmake
              ${PROJECT_BINARY_DIR}/moclean-config-version.cmake
        DESTINATION ${package_dir})
