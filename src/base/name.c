#include "name.h"

#include <ctype.h>
#include <string.h>

static int differ(char a, char b) { return tolower((unsigned char)a) != tolower((unsigned char)b); }

int sph_name_distance(const char *a, const char *b)
{
  enum { CUT = 64 };
  int row[CUT + 1], n = (int)strnlen(a, CUT), m = (int)strnlen(b, CUT);
  for (int j = 0; j <= m; j++) row[j] = j;
  for (int i = 1; i <= n; i++) {
    int diagonal = row[0];
    row[0] = i;
    for (int j = 1; j <= m; j++) {
      int change = diagonal + differ(a[i - 1], b[j - 1]);
      int less = row[j] < row[j - 1] ? row[j] + 1 : row[j - 1] + 1;
      diagonal = row[j];
      row[j] = change < less ? change : less;
    }
  }
  return row[m];
}
