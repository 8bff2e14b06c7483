% BUILD_HYSTERON  Build sf_MKP and sf_Inverse_MKP beside this file, with the compiler of `mex`.
%
%   BUILD_HYSTERON takes the C library of `cargo build --release -p hysteron-capi` from
%   target/release. BUILD_HYSTERON(LIBRARY) takes the static library LIBRARY.
function build_hysteron(library)
here = fileparts(mfilename('fullpath'));
crate = fullfile(fileparts(here), 'crates', 'hysteron-capi');
if nargin < 1
    folder = fullfile(fileparts(here), 'target', 'release');
    library = fullfile(folder, 'libhysteron_capi.a');
    if ispc && exist(library, 'file') ~= 2
        library = fullfile(folder, 'hysteron_capi.lib');
    end
end
if exist(library, 'file') ~= 2
    error('hysteron:notBuilt', ...
        '%s is not there: run `cargo build --release -p hysteron-capi` first', library);
end
if ispc
    system_libraries = {'-lws2_32', '-luserenv', '-lntdll', '-lbcrypt', '-ladvapi32'};
elseif ismac
    system_libraries = {'-lm'};
else
    system_libraries = {'-lm', '-lpthread', '-ldl'};
end
if exist('OCTAVE_VERSION', 'builtin') && isunix && ~ismac
    system_libraries{end + 1} = '-s'; % without the names for a debugger, which are most of the file
end
include = ['-I' fullfile(crate, 'include')];
back = cd(here);
returns = onCleanup(@() cd(back));
for name = {'sf_MKP', 'sf_Inverse_MKP'}
    mex(include, [name{1} '.c'], 'block.c', library, system_libraries{:});
end
end
