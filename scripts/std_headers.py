"""Headers of the standard library that a source names something of and does not include.

With one compiler they come along with others, with the next they do not. A header counts that is included by the file or by one
of the project's that it includes.
"""
import functools
import posixpath
import re

NAMES = {
    'algorithm': 'sort|stable_sort|find|find_if|count|count_if|max_element|min_element|minmax_element|all_of|any_of|none_of|clamp|'
                 'reverse|rotate|transform|fill|fill_n|copy|copy_n|copy_if|remove_if|unique|nth_element|lower_bound|upper_bound|'
                 'equal|is_sorted|generate|for_each|partition|shuffle|min|max|minmax',
    'functional': 'function|greater|less|hash',
    'iterator': 'back_inserter|next|prev|distance|advance|istreambuf_iterator',
    'limits': 'numeric_limits',
    'memory': 'unique_ptr|shared_ptr|make_unique|make_shared|weak_ptr',
    'numeric': 'accumulate|iota|inner_product|partial_sum',
    'optional': 'optional|nullopt|make_optional',
    'stdexcept': 'runtime_error|invalid_argument|logic_error|out_of_range',
}
FOLDERS = ('include', 'src/core', 'src', 'src/ros', 'src/tools', 'test/core', 'test/tools')
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def complaints(sources):
    """A line for each file of a dictionary of contents by name, and each header that it lacks."""
    def path_of(name, included):
        candidates = [posixpath.join(folder, included) for folder in (posixpath.dirname(name),) + FOLDERS]
        return next((path for path in map(posixpath.normpath, candidates) if path in sources and path != name), None)

    @functools.lru_cache(None)
    def headers(name):
        found = set()
        for included in INCLUDE.findall(sources[name]):
            path = path_of(name, included)
            found.update(headers(path) if path else [included])
        return frozenset(found)

    result = []
    for name in sorted(sources):
        code = re.sub(r'//.*', '', sources[name])
        for header, words in sorted(NAMES.items()):
            used = re.search(r'\bstd::({})\b(?!::)'.format(words), code)
            if used and header not in headers(name):
                result.append('{}: std::{} needs <{}>'.format(name, used.group(1), header))
    return result
