% Blocks: shapes, types, memory, info and help.
function blocks()
model = [tempname() '.json'];
tidy = onCleanup(@() delete(model));
write_model(model, '[1, 0.5, 1, 0, 0.5, 1]');
T = [20 80 50; 35 60 40];

y = sf_MKP(model, T(:));
assert(isequal(size(y), [6 1]));
assert(isequal(sf_MKP(model, T), reshape(y, 2, 3)));
assert(isequal(sf_MKP(model, T(:)'), y'));
for type = {'single', 'int16', 'uint8'}
    assert(isequal(sf_MKP(model, feval(type{1}, T)), sf_MKP(model, T)));
end
assert(isequal(sf_MKP(model, [20 80 50]), [11 14 13]));
assert(isempty(sf_MKP(model, [])) && isequal(size(sf_MKP(model, zeros(0, 3))), [0 3]));
[~, clipped] = sf_MKP(model, [-100 50 1000]);
assert(isequal(clipped, int8([-1 0 1])));

block = sf_MKP('open', model);
assert(strcmp(class(block), 'uint64'));
assert(isequal([sf_MKP(block, T(1:4)) sf_MKP(block, T(5:6))], y'));
sf_MKP('reset', block);
assert(isequal(sf_MKP(block, T(:)), y));
sf_MKP('reset', block, 'on');
assert(isequal(sf_MKP(block, 80), 14));
info = sf_MKP('info', block);
assert(isequal(info, sf_MKP('info', model)));
assert(strcmp(info.operator, 'mkp') && info.levels == 3 && isequal(info.range, [20 80]));
assert(strcmp(info.input, 'temperature [degC]') && strcmp(info.output, 'output'));
assert(isequal([info.offset info.sign info.output_off info.output_on], [10 1 10 14]));

% The inverse in front of the model returns the reference. With 'anticipate' the input crosses the
% dead band at once.
wanted = 12 + 1.5 * sin((0:300) / 15);
[T, status] = sf_Inverse_MKP(model, wanted);
assert(max(abs(sf_MKP(model, T) - wanted)) < 1e-12 && ~any(status));
ahead = sf_Inverse_MKP(model, wanted, 'policy', 'anticipate');
assert(max(abs(sf_MKP(model, ahead) - wanted)) <= info.usual_tolerance + 1e-12);
assert(~isequal(ahead, T));
assert(isequal(sf_Inverse_MKP(model, wanted, 'heading', 0), T));
write_model(model, '[0, 1, 0, 1, 1, 0]'); % no operator without memory: a dead band everywhere
rises = sf_Inverse_MKP(model, [12 12], 'heading', [1 1]);
falls = sf_Inverse_MKP(model, [12 12], 'heading', [1 -1]);
assert(falls(2) < rises(2));
[~, status] = sf_Inverse_MKP(model, [9 12 99]);
assert(isequal(status, int8([-1 0 1])));

% Freed with the function; no block of before is one afterwards.
clear sf_MKP
refused = false;
try
    sf_MKP(block, 1);
catch fault
    refused = strcmp(fault.identifier, 'hysteron:block');
end
assert(refused);
for name = {'sf_MKP', 'sf_Inverse_MKP', 'build_hysteron', 'chapter'}
    assert(~isempty(strfind(help(name{1}), upper(name{1}))));
end
printf('blocks: shapes, types, memory, info, help\n');
end
