# find_package(enmm) gives the targets enmm::enmm (shared) and enmm::static, with their headers.
get_filename_component(_enmm_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET enmm::enmm)
  add_library(enmm::enmm SHARED IMPORTED)
  set_target_properties(enmm::enmm PROPERTIES
    @SHARED_PROPERTIES@
    INTERFACE_INCLUDE_DIRECTORIES "${_enmm_prefix}/include")
  add_library(enmm::static STATIC IMPORTED)
  set_target_properties(enmm::static PROPERTIES
    IMPORTED_LOCATION "${_enmm_prefix}/@STATIC_LIBRARY@"
    INTERFACE_LINK_LIBRARIES "@SYSTEM_LIBRARIES@"
    INTERFACE_INCLUDE_DIRECTORIES "${_enmm_prefix}/include")
endif()
unset(_enmm_prefix)
