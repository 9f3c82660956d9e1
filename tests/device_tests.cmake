# How the tests of what runs on a device are run.
# The forms for GPUs; they run anywhere. Only their kernels have barriers (tests/structure/kernels_compile.sh).
set(group_cases *Group*:*group*:*WG*)

if(MOCLEAN_SANITIZE)
  # A small case of every method and form, and what has no shapes.
  set(small *3x5*:*_9x6*:*FirstIterations.*:*FirstSteps.*:*/0:*/3:Batch*:Banded.*:Buffer*:BusyTime*:Device*
            FilledAlongTime*:Kernel*:MatrixNormalDevice*:MissingSamples*:MixedPrecisionBackend*:Norms*:OpenClBackend*:OtherMethods*:Profile*:Program*
            Queues*:ScaleRows*:SymmetricEigen.*)
  string(REPLACE ";" ":" small "${small}")
  moclean_run(device_tests device_tests "GTEST_FILTER=${small}")
  set_tests_properties(device_tests PROPERTIES COST 80)
  return()
endif()

moclean_run(device_tests device_tests "GTEST_FILTER=-${group_cases}")
set_tests_properties(device_tests PROPERTIES COST 150)
# In work-groups of each size as PoCL maps a group to a CPU thread by default, and in one size for each other way.
foreach(method auto loops loopvec)
  set(cases ${group_cases})
  if(NOT method STREQUAL auto)
    set(cases *WG64*:*Group64*)
  endif()
  moclean_run(device_groups_${method} device_tests "GTEST_FILTER=${cases}" POCL_WORK_GROUP_METHOD=${method})
  set_tests_properties(device_groups_${method} PROPERTIES COST 120)
endforeach()

# Oclgrind interprets the kernels and finds races, uses of uninitialised memory and accesses out of
# bounds; tests/oclgrind.cmake fails the test on any finding. Small shapes: it is thousands of times
# slower. CLBlast's own kernels are not ours to answer for. Of each kernel the smallest cases run always,
# all of them by `scripts/test oclgrind`.
find_program(MOCLEAN_OCLGRIND oclgrind)
if(NOT MOCLEAN_OCLGRIND)
  return()
endif()
function(moclean_oclgrind name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SMALL;ALL")
  foreach(set SMALL ALL)
    set(test oclgrind_${name})
    set(when)
    set(cases ${arg_SMALL})
    if(set STREQUAL ALL)
      set(test oclgrind_${name}_all)
      set(when CONFIGURATIONS oclgrind)
      list(APPEND cases ${arg_ALL})
    endif()
    string(REPLACE ";" ":" filter "${cases}")
    add_test(NAME ${test} ${when}
             COMMAND ${CMAKE_COMMAND} -D OCLGRIND=${MOCLEAN_OCLGRIND} -D FILTER=${filter}
                     -D PROGRAM=$<TARGET_FILE:device_tests> -P ${CMAKE_CURRENT_SOURCE_DIR}/oclgrind.cmake)
    set_tests_properties(${test} PROPERTIES TIMEOUT 3600 COST 100)
  endforeach()
endfunction()

moclean_oclgrind(linalg
  SMALL Banded.* *PenaltyIsThat*/1 Norms.* *GroupNorms.A*WG64 ScaleRows.* *ProductsTest.*own_3x5 *SymmetricEigenTest.Decomp*/3 *GroupEigenTest*/WG4_n5 *GroupProducts*/WG16_3x5
  ALL Norms.* *GroupNorms.A*WG64 ScaleRows.* *ProductsTest.*own_3x5 *ProductsTest.*own_17x1 *ProductsTest.*own_25x93 *SymmetricEigenTest.Decomp*/1 *SymmetricEigenTest.Decomp*/3
      *SymmetricEigenTest.Decomp*/9 *GroupEigenTest*/WG4_n5 *GroupEigenTest*/WG64_n16 GroupEigen.DecomposesABatch*
      *GroupProducts*/WG16_3x5 *GroupProductsTest*/WG64_17x1 *GroupProductsTest.Gram*/WG128_25x93
      *GroupProductsTest.R*/WG128_25x93)
moclean_oclgrind(solve
  SMALL *ColumnRecurrence*Scalar1 *FirstIterations.* *FirstSteps.* *OtherMethodAgreement*/OpenClCpu_Tsvd_3x5
        *OtherMethodAgreement*/OpenClCpu_SvtSoft_3x5
  ALL *ColumnRecurrence*Scalar* *GroupSweepTest*WG64_* *GroupTemporalTest.T*WG64
      *OtherMethodAgreement*/OpenClGpuGroup128_Tslra_3x5 *OtherMethodAgreement*/OpenClCpu_*_3x5 *OpenClAgreement*/OpenClCpu_*3x5
      *OpenClAgreement*/OpenClCpu_*100x1 *OpenClAgreement*/OpenClGpuGroup64_ae_3x5 *MixedPrecision.IsWithin*/0
      *MatrixNormalAgreement*/OpenClCpu_9x6 *MatrixNormalAgreement*/OpenClGpuGroup64_9x6
      *MissingAgreement*/OpenClCpu_ae_3x5)
