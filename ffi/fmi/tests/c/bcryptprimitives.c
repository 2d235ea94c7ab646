/* The one function of bcryptprimitives.dll that Rust's standard library calls, for Wine before version 9, which lacks
 * this library. For tests only: it is put into the folder of their Wine and never shipped. */
#include <windows.h>

/* Fills a buffer with random bytes (RtlGenRandom of advapi32.dll). */
BOOLEAN NTAPI SystemFunction036(PVOID buffer, ULONG length);

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE buffer, SIZE_T length)
{
    return SystemFunction036(buffer, (ULONG)length);
}
