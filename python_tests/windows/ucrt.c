/* Functions of complex numbers that the C library of Wine before version 9 lacks and NumPy calls. For tests only. The
 * structures are passed as Microsoft's _Fcomplex and _Dcomplex. */
typedef struct { double re, im; } wide;
typedef struct { float re, im; } narrow;

double creal(wide z) { return z.re; }
double creall(wide z) { return z.re; }
double cimag(wide z) { return z.im; }
double cimagl(wide z) { return z.im; }
float crealf(narrow z) { return z.re; }
float cimagf(narrow z) { return z.im; }
