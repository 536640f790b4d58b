--- What the plugin itself says, in the language of Neovim's messages. The server chooses for itself what it says.
local M = {}

--- English words, as they stand in the sources with the places of |string.format()|, and those in Simplified Chinese.
M.chinese = {
  ['no language server at "%s"; see :checkhealth rungwise'] = '“%s”处没有语言服务器；见 :checkhealth rungwise',
  ['no language server for this buffer; see :checkhealth rungwise'] = '此缓冲区没有语言服务器；见 :checkhealth rungwise',
  ['the program was not checked: %s'] = '程序未能检查：%s',
  ['the server gave no result of the check'] = '服务器没有给出检查结果',
  ['target PLC %s'] = '目标 PLC：%s',
  ['unknown'] = '未知',
  ['there is no target "%s"; known are %s'] = '没有目标“%s”；可用 %s',
  ['there is no ":Rungwise %s"; there are %s'] = '没有“:Rungwise %s”；可用 %s',
  ['there is no edit "%s"'] = '没有编辑“%s”',
  ['the drawing changed meanwhile; nothing was done'] = '图形在此期间已改变；未作更改',
  ['put the cursor on an instruction or an error, or name one'] = '请把光标放到指令或错误上，或写出其名称',
  ['Check, edit, explain: what Rungwise can do'] = '检查、编辑、说明：Rungwise 的全部功能',
  ['Check the program in this buffer'] = '检查此缓冲区中的程序',
  ['Restart the Rungwise language server'] = '重启 Rungwise 语言服务器',
  ['Open the log of the language server'] = '打开语言服务器的日志',
  ['Set the target PLC'] = '设置目标 PLC',
  ['the program does not use "%s"'] = '程序没有使用“%s”',
  ['no device at the cursor; name one'] = '光标处没有软元件；请写出其名称',
  ['Uses of %s'] = '%s 的使用处',
  ['rung %d'] = '梯级 %d',
  ['read'] = '读取',
  ['written'] = '写入',
  ['read and written'] = '读写',
  ['defined'] = '定义',
  ['jumped to'] = '跳转到此',
  ['Show the forms of the rung at the cursor'] = '显示光标处梯级的各种形式',
  ['There is no rung at the cursor.'] = '光标处没有梯级。',
  ['nothing was translated: %s'] = '未能转换：%s',
  ['not everything was translated: %s'] = '并非全部都已转换：%s',
  ['the translation is in the registers " and +'] = '转换结果在寄存器 " 和 + 中',
  ['name the file of the other program'] = '请写出另一程序的文件名',
  ['nothing was proved: %s'] = '未能证明：%s',
  ['"%s" is no relay'] = '“%s”不是继电器',
  ['there is no ":Rungwise simulate %s"; there are %s'] = '没有“:Rungwise simulate %s”；可用 %s',
  ['Rungwise: debug this program'] = 'Rungwise：调试此程序',
  ['  [line %d]'] = '  [第 %d 行]',
  ['Go to the instruction'] = '转到该指令',
  ['Ladder diagram'] = '梯形图',
  ['Instruction list, FX'] = '指令表（FX）',
  ['Instruction list, IEC 61131-3'] = '指令表（IEC 61131-3）',
  ['Boolean form'] = '布尔式',
  ['proved equal'] = '已证明等价',
  ['equal by construction'] = '构造上等价',
  ['not decided'] = '未判定',
  ['Close the page'] = '关闭此页',
  ['%d%s steps'] = '%d%s 步',
  ['insert a contact'] = '插入触点',
  ['insert a negated contact'] = '插入常闭触点',
  ['insert a coil (output)'] = '插入线圈（输出）',
  ['insert a set coil'] = '插入置位线圈',
  ['insert a reset coil'] = '插入复位线圈',
  ['insert an instruction box'] = '插入指令框',
  ['insert a branch: a contact in parallel'] = '插入支路：并联一个触点',
  ['insert a rung below'] = '在下方插入梯级',
  ['insert a rung above'] = '在上方插入梯级',
  ['move the branch up'] = '上移支路',
  ['move the branch down'] = '下移支路',
  ['put a branch in parallel to the selection'] = '与所选部分并联一条支路',
  ['delete the element and close the gap'] = '删除元件并补上连线',
  ['delete the branch'] = '删除支路',
  ['negate (invert) the contact or coil'] = '将触点或线圈取反',
  ['mend the drawing here'] = '修补此处的图形',
  ['around %s'] = '整个%s',
  ['inner %s'] = '%s内部',
  ['element'] = '元件',
  ['branch'] = '支路',
  ['rung'] = '梯级',
  ['network'] = '网络',
  ['%s has vim.lsp.enable'] = '%s 具有 vim.lsp.enable',
  ['%s: the server is started by vim.lsp.start'] = '%s：由 vim.lsp.start 启动服务器',
  ['%s: 0.10 or later is needed'] = '%s：需要 0.10 或更新版本',
  ['named by the option `server`'] = '由选项 `server` 指定',
  ['named by RUNGWISE_SERVER'] = '由 RUNGWISE_SERVER 指定',
  ['found on the PATH'] = '在 PATH 中找到',
  ['found beside the plugin'] = '在插件旁边找到',
  ['there is no program "%s"'] = '没有程序“%s”',
  ['Build the server with `cargo build --release` and put `rungwise` on the PATH,'] = '用 `cargo build --release` 构建服务器，并把 `rungwise` 放入 PATH，',
  ['or set the environment variable RUNGWISE_SERVER,'] = '或设置环境变量 RUNGWISE_SERVER，',
  ["or put `vim.g.rungwise = { server = '/path/to/rungwise' }` into your init.lua."] = "或在 init.lua 中写入 `vim.g.rungwise = { server = '/path/to/rungwise' }`。",
  ['server %s (%s), version %s'] = '服务器 %s（%s），版本 %s',
  ['"%s --version" did not answer as Rungwise does (exit code %s)'] = '“%s --version”没有像 Rungwise 那样应答（退出码 %s）',
  ['no server runs: it starts when a .lad or .il file is opened'] = '没有服务器在运行：打开 .lad 或 .il 文件时启动',
  ['no project: single files'] = '没有项目：单个文件',
  ['client %d, %s, positions in %s'] = '客户端 %d，%s，位置以 %s 计',
  ['attached to %s'] = '附着于 %s',
  ['no buffer'] = '没有缓冲区',
  ['typing: not formatted (`on_type = false`)'] = '输入：不格式化（`on_type = false`）',
  ['typing: formatted by the plugin'] = '输入：由插件格式化',
  ['keys: none (`mappings = false`)'] = '按键：无（`mappings = false`）',
  ['keys: defaults, with <LocalLeader> %s'] = '按键：默认，<LocalLeader> 为 %s',
  ['inlay hints: on'] = '嵌入提示：开',
  ['inlay hints: off; `:lua vim.lsp.inlay_hint.enable()` shows them'] = '嵌入提示：关；用 `:lua vim.lsp.inlay_hint.enable()` 显示',
  ['g:rungwise has an option "%s" that does not exist'] = 'g:rungwise 中的选项“%s”不存在',
  ['See :help rungwise-options'] = '见 :help rungwise-options',
  ['rungwise: Neovim'] = 'rungwise：Neovim',
  ['rungwise: server'] = 'rungwise：服务器',
  ['rungwise: options'] = 'rungwise：选项',
}

--- Language of the plugin's words and, unless an option says otherwise, of the server: 'zh-CN', 'en', or nil where
--- Neovim has no language either (`C`), which leaves the choice to the server.
function M.language()
  local options = type(vim.g.rungwise) == 'table' and vim.g.rungwise or {}
  local chosen = options.language
  if type(chosen) ~= 'string' or chosen == 'auto' then
    chosen = vim.v.lang
  end
  if chosen == '' or chosen == 'C' or chosen:find('^C%.') or chosen == 'POSIX' then
    return nil
  end
  return chosen:lower():find('^zh') and 'zh-CN' or 'en'
end

--- The words `message`, with `...` in its places.
function M.t(message, ...)
  local words = M.language() == 'zh-CN' and M.chinese[message] or message
  return select('#', ...) > 0 and words:format(...) or words
end

return M
