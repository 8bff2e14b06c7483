% Wrong calls: an error with its identifier, and nothing moved.
function refusals()
model = [tempname() '.json'];
bad = [tempname() '.json'];
tidy = onCleanup(@() delete(model, bad));
write_model(model, '[1, 0.5, 1, 0, 0.5, 1]');
block = sf_MKP('open', model);
inverse = sf_Inverse_MKP('open', model);
before = {sf_MKP(block, 47), sf_MKP('save', block)};

argument = 'hysteron:argument';
refused(argument, @() sf_MKP());
refused(argument, @() sf_MKP(model));
refused(argument, @() sf_MKP(model, 'text'));
refused(argument, @() sf_MKP(model, {1, 2}));
refused(argument, @() sf_MKP(model, struct()));
refused(argument, @() sf_MKP(model, [1 2i]));
refused(argument, @() sf_MKP(model, sparse([1 2])));
refused(argument, @() sf_MKP(model, [true false]));
refused(argument, @() sf_MKP(model, 1, 'load'));
refused(argument, @() sf_MKP(model, 1, 'lode', 2));
refused(argument, @() sf_MKP(model, 1, 2, 3));
refused('hysteron:load', @() sf_MKP(block, 1, 'load', 2));
refused(argument, @() sf_MKP(block, 1, 'start', 'off'));
refused(argument, @() sf_MKP('reset', block, 'half'));
refused(argument, @() sf_MKP('restore', block));
refused(argument, @() sf_MKP('restore', block, 7));
refused(argument, @() sf_MKP('restore', block, struct('input', 1)));
refused(argument, @() sf_MKP('open', ['ab'; 'cd']));
refused(argument, @() sf_Inverse_MKP(model, 12, 'policy', 'wait'));
refused(argument, @() sf_Inverse_MKP(model, 12, 'policy', 3));
refused(argument, @() sf_Inverse_MKP(model, 12, 'tolerance', -1));
refused(argument, @() sf_Inverse_MKP(model, 12, 'tolerance', [1 2]));
refused(argument, @() sf_Inverse_MKP(model, [12 13], 'heading', [1 1 1]));
refused(argument, @() sf_Inverse_MKP(model, [12 13], 'heading', [1 0.5]));
refused(argument, @() sf_Inverse_MKP(model, [12 13], 'policy', 'hold', 'heading', [1 1]));
refused(argument, @() sf_Inverse_MKP(inverse, 12, 'policy', 'anticipate'), 'heading');
refused(argument, @() sf_MKP(model, block));
refused(argument, @() sf_MKP(model, int64(50)));
refused(argument, @() sf_MKP([model char(0) 'x'], 50));
refused('hysteron:notFinite', @() sf_MKP(block, [50 NaN]), 'input(2)');
refused('hysteron:notFinite', @() sf_MKP(block, [50 60; -Inf 70]), 'input(2)');
refused('hysteron:notFinite', @() sf_Inverse_MKP(inverse, [12 Inf]), 'target(2)');
refused('hysteron:notFinite', @() sf_Inverse_MKP(inverse, 12, 'tolerance', NaN), 'tolerance');
refused('hysteron:block', @() sf_MKP(uint64(0), 1));
refused('hysteron:block', @() sf_MKP(uint64([1 2]), 1));
refused('hysteron:block', @() sf_MKP(double(block), 1));
refused('hysteron:block', @() sf_MKP(inverse, 1));
refused('hysteron:block', @() sf_Inverse_MKP(block, 1));
refused('hysteron:block', @() sf_MKP('close', block + 1));
refused('hysteron:block', @() sf_MKP('reset', model));
refused('hysteron:file', @() sf_MKP('/no/such/model.json', 1));
refused('hysteron:file', @() sf_MKP('', 1));
refused('hysteron:load', @() sf_MKP(model, 1, 'load', 200));
no_nest = struct('turning_points', [1 2 3], 'input', 1);
refused('hysteron:turningPoints', @() sf_MKP('restore', block, no_nest));
not_finite = struct('turning_points', [1 NaN], 'input', 1);
refused('hysteron:notFinite', @() sf_MKP('restore', block, not_finite));

text = fileread(model);
for length = [0, 1, 40, numel(text) - 2]
    write_text(bad, text(1:length));
    refused('hysteron:modelFile', @() sf_MKP(bad, 1));
end
thermal = ['"thermal": {"kind": "first-order", "gain": 1, ' ...
    '"tau_heating": 1, "tau_cooling": 1}, "weights"'];
write_text(bad, strrep(text, '"weights"', thermal));
refused('hysteron:thermal', @() sf_MKP(bad, [1 2]), 'thermal body');
write_model(bad, '[1, 0.5, 1, 0, 0.5]');
refused('hysteron:modelFile', @() sf_MKP(bad, 1), 'weights');
write_model(bad, '[1, -0.5, 1, 0, 0.5, 1]');
assert(isfinite(sf_MKP(bad, 50)));
refused('hysteron:negativeWeights', @() sf_Inverse_MKP(bad, 12));

assert(isequal(before, {sf_MKP(block, 47), sf_MKP('save', block)}));
sf_MKP('close', block);
refused('hysteron:block', @() sf_MKP('close', block));
refused('hysteron:block', @() sf_MKP(block, 1));
sf_Inverse_MKP('close', inverse);
printf('refusals: each with its identifier\n');
end
